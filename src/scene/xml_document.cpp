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

/// Length of the UTF-8 sequence at `position`; 0 if there is none, or a control character that XML does not allow.
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

/// The end of the comment or CDATA that begins at `i`; `i` where none does.
std::size_t after_opaque(const std::string& text, std::size_t i) {
  if (text.compare(i, 4, "<!--") == 0) return after(text, "-->", i + 4);
  if (text.compare(i, 9, "<![CDATA[") == 0) return after(text, "]]>", i + 9);
  return i;
}

/// First declaration "<!..." that is neither a comment nor CDATA: only these can define entities.
std::size_t find_declaration(const std::string& text) {
  for (std::size_t i = text.find("<!"); i != kEnd; i = text.find("<!", i)) {
    const std::size_t end = after_opaque(text, i);
    if (end == i) return i;
    i = end;
  }
  return kEnd;
}

/// First tag with more attributes than it may have.
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

/// First element that lies too deep, walked without recursion.
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

/// XML has its declaration at the very beginning; licences are put before it all the same.
void tell_parse_error(const std::string& text, const tinyxml2::XMLDocument& document, Findings& findings) {
  const int line = document.ErrorLineNum();
  const std::string name = tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID());
  if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    return findings.error(line, "file", "elements may be nested " + std::to_string(kDeepestNesting) + " deep");
  std::size_t late = kEnd;  // a declaration behind the first tag or comment
  if (document.ErrorID() == tinyxml2::XML_ERROR_PARSING_DECLARATION) late = text.find("<?", text.find('<') + 1);
  while (late != kEnd && line_of(text, late) < line) late = text.find("<?", late + 1);
  if (late != kEnd && line_of(text, late) == line)
    return findings.error(line, "file",
                          "a declaration <?...?> must come first, before comments and elements: move it to line 1",
                          quoted(text.substr(late, text.find('\n', late) - late)));
  findings.error(line, "file", "must be well-formed XML", name);
}

}  // namespace

bool parse_xml(const std::string& text, tinyxml2::XMLDocument& document, Findings& findings) {
  const std::size_t no_utf8 = find_no_utf8(text);
  if (no_utf8 != kEnd) {
    findings.error(line_of(text, no_utf8), "file", "must be text in UTF-8 without control characters",
                   "byte " + std::to_string(static_cast<unsigned char>(text[no_utf8])));
    return false;
  }
  const std::size_t declaration = find_declaration(text);
  if (declaration != kEnd) {
    findings.error(line_of(text, declaration), "file", "document type and entity declarations are not allowed",
                   quoted(text.substr(declaration, 20)));
    return false;
  }
  const std::size_t crowded = find_crowded_tag(text);
  if (crowded != kEnd) {
    findings.error(line_of(text, crowded), "file",
                   "an element may have " + std::to_string(kMostAttributes) + " attributes",
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
