#pragma once
/// Tables in Markdown.

#include <string>
#include <vector>

namespace flexarm::bench {

std::string row(const std::vector<std::string>& cells);
/// Names of the columns and the rule below; the first column to the left, numbers to the right.
std::string head(const std::vector<std::string>& columns);

}  // namespace flexarm::bench
