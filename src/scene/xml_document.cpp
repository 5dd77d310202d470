#include "scene/xml_document.h"

#include <algorithm>
#include <optional>

#include "scene/limits.h"

namespace flexarm::scene {
namespace {

constexpr std::size_t kEnd = std::string::npos;

int line_of(const std::string& text, std::size_t position) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + std::min(position, text.size()), '\n'));
}

/// Length of the UTF-8 sequence at `position`; 0 if it is not valid, or a control character that XML does not allow.
std::size_t utf8_length(const std::string& text, std::size_t position) {
  const auto byte = [&](std::size_t i) -> unsigned { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(position);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xF5 ? 0 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
  if (length == 0 || position + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(position + i) & 0xC0) != 0x80) return 0;
  return length;
}

std::size_t find_no_utf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return i;
    i += length;
  }
  return kEnd;
}

/// Position after `mark`, searched from `from`.
std::size_t after(const std::string& text, const char* mark, std::size_t from) {
  const std::size_t found = text.find(mark, from);
  return found == kEnd ? kEnd : found + std::string_view(mark).size();
}

/// Returns the end of the comment or CDATA section that begins at `i`; `i` itself if none begins there.
std::size_t after_opaque(const std::string& text, std::size_t i) {
  if (text.compare(i, 4, "<!--") == 0) return after(text, "-->", i + 4);
  if (text.compare(i, 9, "<![CDATA[") == 0) return after(text, "]]>", i + 9);
  return i;
}

/// Finds the first "<!..." that is neither a comment nor CDATA. Only such declarations can define entities.
std::size_t find_declaration(const std::string& text) {
  for (std::size_t i = text.find("<!"); i != kEnd; i = text.find("<!", i)) {
    const std::size_t end = after_opaque(text, i);
    if (end == i) return i;
    i = end;
  }
  return kEnd;
}

/// Finds the first tag with more than kMostAttributes attributes.
std::size_t find_crowded_tag(const std::string& text) {
  for (std::size_t i = text.find('<'); i != kEnd; i = text.find('<', i)) {
    if (const std::size_t end = after_opaque(text, i); end != i) {
      i = end;
    } else {
      const std::size_t tag = i;
      for (int attributes = 0; i != kEnd && text[i] != '>'; i = text.find_first_of("='\">", i + 1)) {
        if (text[i] == '=' && ++attributes > kMostAttributes) return tag;
        if (text[i] == '"' || text[i] == '\'') i = text.find(text[i], i + 1);
        if (i == kEnd) return kEnd;
      }
    }
  }
  return kEnd;
}

/// Returns the first element that is nested too deeply. Walks without recursion, so that no document overflows the
/// stack.
const tinyxml2::XMLElement* find_too_deep(const tinyxml2::XMLElement* root) {
  int depth = 1;
  for (const tinyxml2::XMLElement* element = root; element;) {
    if (depth > kDeepestNesting) return element;
    if (const tinyxml2::XMLElement* child = element->FirstChildElement()) {
      element = child;
      ++depth;
      continue;
    }
    while (element && element != root && !element->NextSiblingElement()) {
      element = element->Parent()->ToElement();
      --depth;
    }
    element = !element || element == root ? nullptr : element->NextSiblingElement();
  }
  return nullptr;
}

/// What is wrong with a document that is not well-formed XML.
std::string parse_error_text(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "the file is empty";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT: {
      const std::string_view text = document.ErrorStr();  // "...: XMLElement name=link"
      const std::size_t name = after(std::string(text), "name=", 0);
      if (name == kEnd) return "an element has no end tag of its name";
      const std::string tag(text.substr(name));
      return "<" + tag + "> has no end tag </" + tag + ">";
    }
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "a tag is incomplete";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is not NAME=\"VALUE\", or comes twice";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "text is outside the outermost element";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
      return "a CDATA section has no end ]]>";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment has no end -->";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
      return "a declaration has no end ?>";
    default:
      return "it ends too early";
  }
}

/// Records an error of the parser. A declaration that is not at the very beginning gets a message of its own, since
/// many files have a licence before it.
void tell_parse_error(const std::string& text, const tinyxml2::XMLDocument& document, Findings& findings) {
  const int line = std::max(1, document.ErrorLineNum());  // the parser says 0 for an empty document
  if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    return findings.error(line, "", "elements may be nested " + std::to_string(kDeepestNesting) + " deep");
  std::size_t late = kEnd;  // position of a declaration after the first tag or comment
  if (document.ErrorID() == tinyxml2::XML_ERROR_PARSING_DECLARATION) late = text.find("<?", text.find('<') + 1);
  while (late != kEnd && line_of(text, late) < line) late = text.find("<?", late + 1);
  if (late != kEnd && line_of(text, late) == line)
    return findings.error(line, "",
                          "a declaration <?...?> must come first, before comments and elements: move it to line 1",
                          quoted(text.substr(late, text.find('\n', late) - late)));
  findings.error(line, "", "must be well-formed XML, but " + parse_error_text(document));
}

}  // namespace

bool parse_xml(const std::string& text, tinyxml2::XMLDocument& document, Findings& findings) {
  const std::size_t no_utf8 = find_no_utf8(text);
  if (no_utf8 != kEnd) {
    findings.error(line_of(text, no_utf8), "", "must be text in UTF-8 without control characters",
                   "byte " + std::to_string(static_cast<unsigned char>(text[no_utf8])));
    return false;
  }
  const std::size_t declaration = find_declaration(text);
  if (declaration != kEnd) {
    findings.error(line_of(text, declaration), "", "document type and entity declarations are not allowed",
                   quoted(text.substr(declaration, 20)));
    return false;
  }
  const std::size_t crowded = find_crowded_tag(text);
  if (crowded != kEnd) {
    findings.error(line_of(text, crowded), "", "an element may have " + std::to_string(kMostAttributes) + " attributes",
                   quoted(text.substr(crowded, 20)));
    return false;
  }
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    tell_parse_error(text, document, findings);
    return false;
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (const tinyxml2::XMLElement* second = root ? root->NextSiblingElement() : nullptr) {
    findings.error(second->GetLineNum(), "<" + std::string(second->Name()) + ">",
                   "a file has one outermost element, and <" + std::string(root->Name()) + "> of line " +
                       std::to_string(root->GetLineNum()) + " has ended before this one");
    return false;
  }
  if (const tinyxml2::XMLElement* deep = find_too_deep(document.RootElement())) {
    findings.error(deep->GetLineNum(), "<" + std::string(deep->Name()) + ">",
                   "elements may be nested " + std::to_string(kDeepestNesting) + " deep");
    return false;
  }
  return true;
}

}  // namespace flexarm::scene
