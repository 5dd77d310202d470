/// Gives every number in scenes every hostile value, one at a time, each in a process of its own that has 30 s and
/// 2 GiB: sweep [--every N] [--from FIRST] SCENE... Prints what must not be; the exit status is 1 if there is any.
///
/// `--every N`: every N-th case only, from the first or FIRST on.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fuzz/try_scene.h"
#include "math/parse_number.h"

namespace flexarm::fuzz {
namespace {

// Three steps, each of which may be halved 500 times: the slowest scene that ends takes 75000 iterations, or 8 s.
constexpr rlim_t kSeconds = 30, kBytes = rlim_t{2} << 30;
constexpr const char* kValues[] = {"0",     "-0",  "1e-320", "1e-30", "1e30", "1e300",      "-1e300",
                                   "nan",   "inf", "-1",     "1e6",   "7",    "2147483648", "99999999999999999999",
                                   "1e-300"};

/// Where a number stands in a text.
struct Place {
  std::size_t begin, size;
  std::string attribute;
};

/// The numbers of an attribute, whose value is `size` characters from `begin`; none if it is something else, too.
std::vector<Place> numbers_of(const std::string& text, std::size_t begin, std::size_t size, const std::string& name) {
  std::vector<Place> places;
  std::string_view rest(text.data() + begin, size);
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    if (!parse_number(word)) return {};
    places.push_back({static_cast<std::size_t>(word.data() - text.data()), word.size(), name});
  }
  return places;
}

/// Every number in an attribute of a scene that is well-formed XML.
std::vector<Place> numbers_in(const std::string& text) {
  std::vector<Place> places;
  for (std::size_t i = text.find("=\""); i != std::string::npos; i = text.find("=\"", i)) {
    const std::size_t name = text.find_last_of(" \t\n", i) + 1, begin = i + 2, end = text.find('"', begin);
    if (end == std::string::npos) break;
    for (const Place& place : numbers_of(text, begin, end - begin, text.substr(name, i - name)))
      places.push_back(place);
    i = end;
  }
  return places;
}

/// What a process of its own makes of a scene, in words; empty if nothing is wrong. `end` gets how it ended.
std::string tried_apart(const std::string& text, const std::string& name, std::string& end) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    const rlimit seconds{kSeconds, kSeconds + 1}, bytes{kBytes, kBytes};
    setrlimit(RLIMIT_CPU, &seconds);
    setrlimit(RLIMIT_AS, &bytes);
    const Trial trial = try_scene(text, name);
    const char* const kEnds[] = {"refused", "ran", "failed"};
    const std::string report = std::string(kEnds[static_cast<int>(trial.end)]) + "\n" + trial.wrong;
    const bool is_sent = write(ends[1], report.data(), report.size()) == static_cast<ssize_t>(report.size());
    _exit(is_sent ? 0 : 1);
  }
  close(ends[1]);
  std::string report;
  char part[4096];
  for (ssize_t size; (size = read(ends[0], part, sizeof part)) > 0;)
    report.append(part, static_cast<std::size_t>(size));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  end = "killed";
  if (WIFSIGNALED(status)) return fmt::format("{} (signal {})", strsignal(WTERMSIG(status)), WTERMSIG(status));
  const std::size_t line = report.find('\n');
  end = report.substr(0, line);
  return line == std::string::npos ? "no report" : report.substr(line + 1);
}

class Sweep {
 public:
  Sweep(long every, long first) : every_(every), next_(first) {}

  void scene(const std::string& path) {
    std::stringstream stream;
    stream << std::ifstream(path).rdbuf();
    const std::string text = stream.str(), name = path.substr(path.rfind('/') + 1);
    for (const Place& place : numbers_in(text))
      for (const char* value : kValues)
        if (is_next()) attempt(text, name, place, value);
  }
  int report() const {
    fmt::print("{} of {} cases:", tried_, count_);
    for (const auto& [end, number] : ends_) fmt::print(" {} {},", number, end);
    fmt::print(" {} wrong\n", wrong_);
    return wrong_ > 0 || tried_ == 0 ? 1 : 0;
  }

 private:
  bool is_next() {
    if (count_++ < next_) return false;
    next_ += every_;
    return true;
  }
  void attempt(const std::string& text, const std::string& name, const Place& place, const char* value) {
    std::string changed = text, end;
    changed.replace(place.begin, place.size, value);
    const std::string wrong = tried_apart(changed, name, end);
    ++tried_;
    ++ends_[end];
    if (wrong.empty()) return;
    ++wrong_;
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place.begin), '\n');
    fmt::print("{}:{}: {} {} -> {} (case {}): {}\n", name, line, place.attribute, text.substr(place.begin, place.size),
               value, count_ - 1, wrong);
    std::fflush(stdout);
  }

  long every_, next_, count_ = 0, tried_ = 0, wrong_ = 0;
  std::map<std::string, long> ends_;
};

}  // namespace
}  // namespace flexarm::fuzz

int main(int argc, char** argv) {
  long every = 1, first = 0;
  std::vector<std::string> scenes;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--every" && i + 1 < argc)
      every = std::max(1L, std::atol(argv[++i]));
    else if (argument == "--from" && i + 1 < argc)
      first = std::atol(argv[++i]);
    else
      scenes.push_back(argument);
  }
  flexarm::fuzz::Sweep sweep(every, first);
  for (const std::string& scene : scenes) sweep.scene(scene);
  return sweep.report();
}
