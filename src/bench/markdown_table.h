#pragma once
/// Makes tables in Markdown.

#include <string>
#include <vector>

namespace flexarm::bench {

std::string row(const std::vector<std::string>& cells);
/// The names of the columns and the line below them. The first column is left-aligned, the others are right-aligned.
std::string head(const std::vector<std::string>& columns);

}  // namespace flexarm::bench
