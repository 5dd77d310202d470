#include "cli/command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

#include <boost/make_shared.hpp>
#include <boost/program_options.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/exit_status.h"
#include "flexarm/math/near_names.h"
#include "math/number_text.h"

namespace flexarm::cli {

namespace po = boost::program_options;

// ---------------------------------------------------------------- words

Check whole_number_between(int least, int most) {
  return [=](const std::string& word) {
    const std::optional<double> number = parse_number(word);
    const bool is_good = number && *number >= least && *number <= most && *number == std::floor(*number);
    return is_good ? "" : fmt::format("must be a whole number from {} to {}, got '{}'", least, most, word);
  };
}

std::string check_positive(const std::string& word) {
  const std::optional<double> number = parse_number(word);
  return number && *number > 0 ? "" : "must be a number > 0, got '" + word + "'";
}

std::string check_non_negative(const std::string& word) {
  const std::optional<double> number = parse_number(word);
  return number && *number >= 0 ? "" : "must be a number >= 0, got '" + word + "'";
}

std::string check_existing_file(const std::string& word) {
  std::error_code error;
  if (!std::filesystem::exists(word, error)) return "there is no file '" + word + "'";
  return std::filesystem::is_directory(word, error) ? "must be a file, '" + word + "' is a folder" : "";
}

std::string read_words(const Words& words, std::string& value) {
  value = words.front();
  return "";
}

std::string read_words(const Words& words, double& value) {
  const std::optional<double> number = parse_number(words.front());
  if (!number) return "must be a number, got '" + words.front() + "'";
  value = *number;
  return "";
}

std::string read_words(const Words& words, int& value) {
  const int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  if (const std::string wrong = whole_number_between(least, most)(words.front()); !wrong.empty()) return wrong;
  value = static_cast<int>(*parse_number(words.front()));
  return "";
}

std::string text_of(const std::string& value) {
  return value;
}

std::string text_of(double value) {
  return fmt::format("{:g}", value);
}

std::string text_of(int value) {
  return fmt::format("{}", value);
}

// ---------------------------------------------------------------- options

Option& Option::check(Check check) {
  checks_.push_back(std::move(check));
  return *this;
}

Option& Option::choices(Words choices) {
  choices_ = choices;
  return check([choices = std::move(choices)](const std::string& word) {
    if (std::find(choices.begin(), choices.end(), word) != choices.end()) return std::string();
    return fmt::format("must be one of {}, got '{}'{}", fmt::join(choices, ", "), word, suggestion(word, choices));
  });
}

Option& Option::shown_as(const std::string& words) {
  shown_as_ = words;
  return *this;
}

Option& Option::shows_default() {
  shows_default_ = true;
  return *this;
}

Option& Option::with_commas() {
  has_commas_ = true;
  return *this;
}

Option& Option::takes(int words) {
  exactly_ = words;
  return *this;
}

Option& Option::needs(const std::string& other) {
  needs_.push_back(other);
  return *this;
}

Option& Option::excludes(const std::string& other) {
  excludes_.push_back(other);
  return *this;
}

std::string Option::value_text() const {
  const bool may_be_more = number_ == Number::Several && exactly_ == 0;
  return (has_few_choices() ? fmt::format("{}", fmt::join(choices_, "|")) : shown_as_) + (may_be_more ? " ..." : "");
}

std::string Option::help_text() const {
  std::string text = help_;
  if (!choices_.empty() && !has_few_choices()) text += fmt::format(": {}", fmt::join(choices_, ", "));
  if (shows_default_ && number_ == Number::Several) text += fmt::format(" (default: {})", default_);
  return text;
}

bool Option::has_few_choices() const {
  constexpr std::size_t kMostLetters = 30;
  return !choices_.empty() && fmt::format("{}", fmt::join(choices_, "|")).size() <= kMostLetters;
}

std::string Option::take(const std::vector<Words>& occurrences) const {
  if (occurrences.size() > 1 && number_ == Number::One) return "must be given once";
  Words all;
  for (const Words& words : occurrences) {
    if (exactly_ > 0 && words.size() != static_cast<std::size_t>(exactly_))
      return fmt::format("must be followed by {} words, got '{}'", exactly_, fmt::join(words, " "));
    for (const std::string& word : words)
      for (std::size_t begin = 0; begin <= word.size();) {
        const std::size_t end = has_commas_ ? std::min(word.find(',', begin), word.size()) : word.size();
        all.push_back(word.substr(begin, end - begin));
        begin = end + 1;
      }
  }
  for (const std::string& word : all)
    for (const Check& check : checks_)
      if (std::string wrong = check(word); !wrong.empty()) return wrong;
  return read_(all);
}

std::vector<Completion> completions_of(const std::string& typed, const std::vector<Completion>& all) {
  std::vector<Completion> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out),
               [&](const Completion& one) { return one.word.compare(0, typed.size(), typed) == 0; });
  return out;
}

// ---------------------------------------------------------------- declarations

Command::Command(std::string full_name, std::string description)
    : full_name_(std::move(full_name)), description_(std::move(description)) {}

Option& Command::add(const std::string& names, const std::string& help, Option::Number number,
                     const std::string& shown_as, const std::string& default_text, Option::Read read) {
  Option& option = options_.emplace_back();
  const std::size_t comma = names.find(',');
  if (comma != std::string::npos) option.short_name_ = names.substr(0, comma);
  option.name_ = comma == std::string::npos ? names : names.substr(comma + 1);
  option.help_ = help;
  option.heading_ = heading_;
  option.number_ = number;
  option.shown_as_ = shown_as;
  option.default_ = default_text;
  option.read_ = std::move(read);
  return option;
}

Option& Command::argument(const std::string& name, std::string& value, const std::string& help) {
  Option& argument = arguments_.emplace_back();
  argument.name_ = name;
  argument.help_ = help;
  argument.read_ = [&value](const Words& words) { return read_words(words, value); };
  return argument;
}

Option& Command::option_of_words(const std::string& names, Option::Read read, const std::string& help) {
  return add(names, help, Option::Number::Several, kind_of_words(std::string()), "", std::move(read));
}

Option& Command::flag(const std::string& name, bool& value, const std::string& help) {
  return flag(
      name, [&value] { value = true; }, help);
}

Option& Command::flag(const std::string& name, const std::function<void()>& action, const std::string& help) {
  return add(name, help, Option::Number::None, "", "", [action](const Words&) {
    action();
    return "";
  });
}

const Option* Command::find(const std::string& name) const {
  for (const Option& option : options_)
    if (option.name_ == name || option.short_name_ == name) return &option;
  return nullptr;
}

// ---------------------------------------------------------------- help

/// The options in the form that Boost needs.
struct Command::Described {
  /// All headings with their options, for parsing and for the help.
  static po::options_description all(const Command& command) {
    constexpr unsigned kLineLength = 100;
    po::options_description all(kLineLength), own("Help", kLineLength);
    std::vector<std::string> headings;
    for (const Option& option : command.options_)
      if (std::find(headings.begin(), headings.end(), option.heading_) == headings.end())
        headings.push_back(option.heading_);
    for (const std::string& heading : headings) {
      po::options_description group(heading, kLineLength);
      for (const Option& option : command.options_)
        if (option.heading_ == heading) group.add(one(option));
      all.add(group);
    }
    own.add_options()("help,h", "prints this help");
    all.add(own);
    return all;
  }

  static boost::shared_ptr<po::option_description> one(const Option& option) {
    const std::string names =  // "output,o"
        option.name_.substr(2) + (option.short_name_.empty() ? "" : "," + option.short_name_.substr(1));
    const std::string help = option.help_text();
    if (option.number_ == Option::Number::None)
      return boost::make_shared<po::option_description>(names.c_str(), new po::untyped_value(true), help.c_str());
    auto* words = po::value<Words>()->value_name(option.value_text());
    if (option.shows_default_ && option.number_ == Option::Number::One) words->default_value({}, option.default_);
    if (option.number_ == Option::Number::Several && option.exactly_ != 1) words->multitoken();
    return boost::make_shared<po::option_description>(names.c_str(), words, help.c_str());
  }
};

void Command::print_help() const {
  fmt::print("{}\nUsage: {} [OPTIONS]", description_, full_name_);
  for (const Option& argument : arguments_) fmt::print(" {}", argument.name_);
  fmt::print("\n");
  if (!arguments_.empty()) fmt::print("\n");
  for (const Option& argument : arguments_) fmt::print("  {:<10} {}\n", argument.name_, argument.help_);
  std::ostringstream options;
  options << Described::all(*this);
  fmt::print("{}", options.str());
}

// ---------------------------------------------------------------- what is typed

struct Command::Typed {
  std::map<const Option*, std::vector<Words>> options;  // with the words of each occurrence
  Words arguments;
  Words* last_list = nullptr;  // words of the last option, if it takes several words
  bool wants_help = false;
};

void Command::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}\n'{} --help' lists what is expected", full_name_, what, full_name_));
}

int Command::run(const Words& words) const {
  Typed typed = take_apart(words);
  if (typed.wants_help) {
    print_help();
    return kDone;
  }
  leave_arguments(typed);
  require_good_company(typed);
  const auto take = [this](const Option& option, const std::vector<Words>& occurrences) {
    if (const std::string wrong = option.take(occurrences); !wrong.empty()) fail(option.name_ + ": " + wrong);
  };
  for (const Option& option :
       options_)  // before the arguments: if an option takes a word too many, an argument is missing
    if (const auto given = typed.options.find(&option); given != typed.options.end()) take(option, given->second);
  require_arguments(typed);
  for (std::size_t i = 0; i < arguments_.size(); ++i) take(arguments_[i], {{typed.arguments[i]}});
  return run_();
}

Command::Typed Command::take_apart(const Words& words) const {
  // All styles of unix but guessing: an abbreviation that is unique today may be ambiguous with later options.
  namespace style = po::command_line_style;
  constexpr int kStyle = style::allow_long | style::long_allow_adjacent | style::long_allow_next | style::allow_short |
                         style::short_allow_adjacent | style::short_allow_next | style::allow_dash_for_short;
  const po::options_description described = Described::all(*this);
  po::parsed_options parsed(&described);
  try {
    parsed = po::command_line_parser(words).options(described).style(kStyle).allow_unregistered().run();
  } catch (const po::error& error) {
    fail(error.what());
  }
  Typed typed;
  for (const po::option& one : parsed.options) {
    typed.last_list = nullptr;
    if (one.string_key.empty()) {
      typed.arguments.push_back(one.value.front());
      continue;
    }
    if (one.string_key == "help") {
      typed.wants_help = true;
      continue;
    }
    const Option* option = one.unregistered ? nullptr : find("--" + one.string_key);
    if (!option) fail_unknown(one.original_tokens.front());
    std::vector<Words>& occurrences = typed.options[option];
    occurrences.push_back(one.value);
    if (option->number_ == Option::Number::Several && option->exactly_ == 0) typed.last_list = &occurrences.back();
  }
  return typed;
}

void Command::fail_unknown(const std::string& token) const {
  const std::string typed = token.substr(0, token.find('='));
  std::vector<std::string> names = {"--help"};
  for (const Option& option : options_) names.push_back(option.name_);
  fail("there is no option '" + typed + "'" + suggestion(typed, names));
}

/// If arguments are missing, the last words of a list become arguments: `--set mass=1 scene.urdf`.
void Command::leave_arguments(Typed& typed) const {
  if (!typed.last_list || typed.arguments.size() >= arguments_.size()) return;
  Words& list = *typed.last_list;
  const std::size_t missing = arguments_.size() - typed.arguments.size();
  if (list.size() <= missing) return;
  typed.arguments.insert(typed.arguments.end(), list.end() - static_cast<std::ptrdiff_t>(missing), list.end());
  list.resize(list.size() - missing);
}

void Command::require_arguments(const Typed& typed) const {
  if (typed.arguments.size() < arguments_.size())
    fail(arguments_[typed.arguments.size()].name_ + " is missing: " + arguments_[typed.arguments.size()].help_);
  if (typed.arguments.size() > arguments_.size()) fail("unexpected '" + typed.arguments[arguments_.size()] + "'");
}

void Command::require_good_company(const Typed& typed) const {
  for (const auto& [option, occurrences] : typed.options) {
    for (const std::string& other : option->needs_)
      if (typed.options.count(find(other)) == 0) fail(option->name_ + " needs " + other);
    for (const std::string& other : option->excludes_)
      if (typed.options.count(find(other)) > 0) fail(option->name_ + " excludes " + other);
  }
}

std::vector<Completion> Command::complete(const Words& words) const {
  const std::string typed = words.empty() ? "" : words.back();
  if (words.size() > 1)
    if (const Option* before = find(words[words.size() - 2]); before && before->number_ != Option::Number::None) {
      std::vector<Completion> all;
      for (const std::string& choice : before->choices_) all.push_back({choice, ""});
      return completions_of(typed, all);
    }
  if (typed.empty() || typed[0] != '-') return {};
  std::vector<Completion> all;
  for (const Option& option : options_) all.push_back({option.name_, option.help_});
  all.push_back({"--help", "prints this help"});
  return completions_of(typed, all);
}

}  // namespace flexarm::cli
