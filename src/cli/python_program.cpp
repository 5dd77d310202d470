#include "cli/python_program.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>

#include <unistd.h>

#include <fmt/format.h>

#include "cli/installation.h"

namespace flexarm::cli {

void become_python(const std::string& command, const std::vector<std::string>& program,
                   const std::vector<std::string>& arguments) {
  const std::optional<std::string> folder = python_folder();
  if (!folder) throw std::runtime_error(command + ": the Python package flexarm is not installed beside this program");
  const char* others = std::getenv("PYTHONPATH");
  const std::string path = others && *others ? *folder + ":" + others : *folder;
  setenv("PYTHONPATH", path.c_str(), 1);
  // -P: a file of the folder where we are must not take the place of a module.
  std::vector<std::string> words = {"/usr/bin/python3", "-P"};
  words.insert(words.end(), program.begin(), program.end());
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw std::runtime_error(fmt::format("{}: cannot run '{}': {}", command, words.front(), std::strerror(errno)));
}

}  // namespace flexarm::cli
