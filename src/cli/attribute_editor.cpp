#include "cli/attribute_editor.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

namespace flexarm::cli {
namespace {

constexpr std::size_t kNone = std::string::npos;

/// Of an attribute in a tag: its name's begin, and the value between its quotes.
struct AttributePlace {
  std::string name;
  std::size_t begin, value_begin, value_end;
};

bool is_space(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/// The end of a comment, CDATA or declaration that begins at `i`; `i` where none does.
std::size_t after_opaque(const std::string& text, std::size_t i) {
  for (const auto& [begin, end] :
       {std::pair<std::string_view, std::string_view>("<!--", "-->"), {"<![CDATA[", "]]>"}, {"<?", "?>"}, {"<!", ">"}})
    if (text.compare(i, begin.size(), begin) == 0) {
      const std::size_t found = text.find(end, i + begin.size());
      return found == kNone ? text.size() : found + end.size();
    }
  return i;
}

/// Behind the '>' of the tag that begins at `i`.
std::size_t after_tag(const std::string& text, std::size_t i) {
  char quote = 0;
  for (; i < text.size(); ++i) {
    if (quote != 0) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '>') {
      return i + 1;
    }
  }
  return text.size();
}

std::size_t after_name(const std::string& text, std::size_t i) {
  while (i < text.size() && !is_space(text[i]) && text[i] != '=' && text[i] != '>' && text[i] != '/') ++i;
  return i;
}

std::vector<AttributePlace> attributes(const std::string& text, std::size_t tag) {
  std::vector<AttributePlace> found;
  const std::size_t end = after_tag(text, tag);
  std::size_t i = after_name(text, tag + 1);
  while (true) {
    while (i < end && is_space(text[i])) ++i;
    const std::size_t begin = i, name_end = after_name(text, i), quote = text.find_first_of("\"'", name_end);
    if (name_end == begin || quote >= end) return found;
    const std::size_t value_end = text.find(text[quote], quote + 1);
    if (value_end == kNone) return found;
    found.push_back({text.substr(begin, name_end - begin), begin, quote + 1, value_end});
    i = value_end + 1;
  }
}

std::string decoded(std::string text) {
  for (const auto& [entity, character] :
       {std::pair("&lt;", "<"), {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}})
    for (std::size_t i = text.find(entity); i != kNone; i = text.find(entity, i + 1))
      text.replace(i, std::string_view(entity).size(), character);
  return text;
}

std::string value_of(const std::string& text, std::size_t tag, const std::string& name) {
  for (const AttributePlace& attribute : attributes(text, tag))
    if (attribute.name == name)
      return decoded(text.substr(attribute.value_begin, attribute.value_end - attribute.value_begin));
  return "";
}

}  // namespace

std::vector<TagPlace> find_tags(const std::string& text) {
  std::vector<TagPlace> tags;
  std::vector<std::string> open, links;
  for (std::size_t i = text.find('<'); i != kNone; i = text.find('<', i)) {
    if (const std::size_t end = after_opaque(text, i); end != i) {
      i = end;
      continue;
    }
    const std::size_t end = after_tag(text, i);
    if (text[i + 1] == '/') {
      if (!open.empty()) open.pop_back(), links.pop_back();
    } else {
      TagPlace tag{text.substr(i + 1, after_name(text, i + 1) - i - 1),
                   open,
                   links.empty() ? "" : links.back(),
                   i,
                   end,
                   text[end - 2] == '/'};
      if (!tag.is_empty) {
        open.push_back(tag.name);
        links.push_back(tag.name == "link" ? value_of(text, i, "name") : tag.link);
      }
      tags.push_back(std::move(tag));
    }
    i = end;
  }
  return tags;
}

void set_attribute(std::string& text, std::size_t begin, const std::string& name, const std::string& value) {
  const std::vector<AttributePlace> all = attributes(text, begin);
  for (const AttributePlace& attribute : all)
    if (attribute.name == name) {
      text.replace(attribute.value_begin, attribute.value_end - attribute.value_begin, value);
      return;
    }
  const std::size_t place = all.empty() ? after_name(text, begin + 1) : all.back().value_end + 1;
  text.insert(place, " " + name + "=\"" + value + "\"");
}

void remove_attribute(std::string& text, std::size_t begin, const std::string& name) {
  for (const AttributePlace& attribute : attributes(text, begin))
    if (attribute.name == name) {
      std::size_t from = attribute.begin;
      while (is_space(text[from - 1])) --from;
      text.erase(from, attribute.value_end + 1 - from);
      return;
    }
}

}  // namespace flexarm::cli
