#include "bench/markdown_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flexarm::bench {

std::string row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string head(const std::vector<std::string>& columns) {
  std::string rule = "|---|";
  for (std::size_t i = 1; i < columns.size(); ++i) rule += "--:|";
  return row(columns) + rule + "\n";
}

}  // namespace flexarm::bench
