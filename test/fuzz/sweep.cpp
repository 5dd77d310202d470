/// Replaces each number in scenes by each hostile value, one at a time: sweep [--every N] [--from FIRST] SCENE... Each
/// case has 30 s and 2 GiB. Child processes try some cases each, so that a case may end its process. Prints wrong
/// behaviour; the exit status is 1 if there is any.
///
/// `--every N`: tries only every N-th case, from the first one, or from FIRST.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
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
#include "math/number_text.h"

namespace flexarm::fuzz {
namespace {

// A case makes three steps, each of which may be halved 500 times. The slowest scene that ends takes 75000 iterations,
// or 8 s.
constexpr rlim_t kSeconds = 30, kBytes = rlim_t{2} << 30;
/// Number of cases that one process tries: starting a process takes as long as trying a scene.
constexpr std::size_t kTogether = 32;
constexpr const char* kValues[] = {"0",     "-0",  "1e-320", "1e-30", "1e30", "1e300",      "-1e300",
                                   "nan",   "inf", "-1",     "1e6",   "7",    "2147483648", "99999999999999999999",
                                   "1e-300"};

/// The position of a number in a text.
struct Place {
  std::size_t begin, size;
  std::string attribute;
};

/// Returns the numbers of an attribute whose value has `size` characters from `begin` on. Returns none if the value
/// contains anything but numbers.
std::vector<Place> numbers_of(const std::string& text, std::size_t begin, std::size_t size, const std::string& name) {
  std::vector<Place> places;
  std::string_view rest(text.data() + begin, size);
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    if (!parse_number(word)) return {};
    places.push_back({static_cast<std::size_t>(word.data() - text.data()), word.size(), name});
  }
  return places;
}

/// Returns every number in the attributes of a scene, which is well-formed XML.
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

/// A scene with one changed number.
struct Case {
  long number;
  std::string text, name, words;  ///< words: which number is changed, and the new value
};
/// How the trial of a case ended, and a description of what is wrong, which is empty if nothing is.
struct Outcome {
  std::string end, wrong;
};

void set_soft_limit(int what, rlim_t value) {
  rlimit limit;
  getrlimit(what, &limit);
  limit.rlim_cur = std::min(value, limit.rlim_max);
  setrlimit(what, &limit);
}

/// Allows the process this much more time and memory. Hard limits are unchanged: only root can raise them again for the
/// next case.
void set_limits() {
  timespec used;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  set_soft_limit(RLIMIT_CPU, static_cast<rlim_t>(used.tv_sec) + 1 + kSeconds);
  set_soft_limit(RLIMIT_AS, kBytes);
}

/// Tries the cases from `first` on in this process. Writes two lines for each case: how it ended, and what is wrong.
[[noreturn]] void try_and_tell(const std::vector<Case>& cases, std::size_t first, int file) {
  for (std::size_t i = first; i < cases.size(); ++i) {
    set_limits();
    const Trial trial = try_scene(cases[i].text, cases[i].name);
    const char* const kEnds[] = {"refused", "ran", "failed"};
    std::string wrong = trial.wrong;
    std::replace(wrong.begin(), wrong.end(), '\n', ' ');
    const std::string report = std::string(kEnds[static_cast<int>(trial.end)]) + "\n" + wrong + "\n";
    if (write(file, report.data(), report.size()) != static_cast<ssize_t>(report.size())) _exit(1);
  }
  _exit(0);
}

/// Reads from `file` until it is closed.
std::string read_all(int file) {
  std::string text;
  char part[4096];
  for (ssize_t size; (size = read(file, part, sizeof part)) > 0;) text.append(part, static_cast<std::size_t>(size));
  return text;
}

/// Tries the cases from `first` on in a child process and returns their outcomes. If a case ends the process, its
/// outcome is the last one.
std::vector<Outcome> tried_apart(const std::vector<Case>& cases, std::size_t first) {
  int ends[2];
  if (pipe(ends) != 0) return {{"killed", "no pipe"}};
  const pid_t child = fork();
  if (child == 0) try_and_tell(cases, first, ends[1]);
  close(ends[1]);
  std::istringstream reports(read_all(ends[0]));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  std::vector<Outcome> outcomes;
  for (Outcome outcome; std::getline(reports, outcome.end) && std::getline(reports, outcome.wrong);)
    outcomes.push_back(outcome);
  if (first + outcomes.size() < cases.size()) {
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    outcomes.push_back(
        {"killed", signal ? fmt::format("{} (signal {})", strsignal(signal), signal) : std::string("no report")});
  }
  return outcomes;
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
        if (is_next()) add(text, name, place, value);
    attempt();
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
  void add(const std::string& text, const std::string& name, const Place& place, const char* value) {
    std::string changed = text;
    changed.replace(place.begin, place.size, value);
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place.begin), '\n');
    cases_.push_back(
        {count_ - 1, changed, name,
         fmt::format("{}:{}: {} {} -> {}", name, line, place.attribute, text.substr(place.begin, place.size), value)});
    if (cases_.size() == kTogether) attempt();
  }
  void attempt() {
    for (std::size_t done = 0; done < cases_.size();) {
      for (const Outcome& outcome : tried_apart(cases_, done)) tell(cases_[done++], outcome);
    }
    cases_.clear();
  }
  void tell(const Case& tried, const Outcome& outcome) {
    ++tried_;
    ++ends_[outcome.end];
    if (outcome.wrong.empty()) return;
    ++wrong_;
    fmt::print("{} (case {}): {}\n", tried.words, tried.number, outcome.wrong);
    std::fflush(stdout);
  }

  std::vector<Case> cases_;
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
