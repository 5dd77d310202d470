#pragma once
/// Declares a command and its options, once for parsing (by Boost), help and completion.

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flexarm::cli {

using Words = std::vector<std::string>;

// ---------------------------------------------------------------- words

/// Says what is wrong with a word; empty: nothing.
using Check = std::function<std::string(const std::string& word)>;

Check whole_number_between(int least, int most);
/// Accepts a finite number > 0, or >= 0.
std::string check_positive(const std::string& word);
std::string check_non_negative(const std::string& word);
/// Accepts an existing file.
std::string check_existing_file(const std::string& word);

/// Converts words to a value. @returns what is wrong with the words, or ""
std::string read_words(const Words& words, std::string& value);
std::string read_words(const Words& words, double& value);
std::string read_words(const Words& words, int& value);
template <class T>
std::string read_words(const Words& words, std::optional<T>& value) {
  return read_words(words, value.emplace());
}
template <class T>
std::string read_words(const Words& words, std::vector<T>& values) {
  values.clear();
  for (const std::string& word : words)
    if (const std::string wrong = read_words({word}, values.emplace_back()); !wrong.empty()) return wrong;
  return "";
}

/// The text that a user would type for a value.
std::string text_of(const std::string& value);
std::string text_of(double value);
std::string text_of(int value);
template <class T>
std::string text_of(const std::optional<T>& value) {
  return value ? text_of(*value) : "";
}
template <class T>
std::string text_of(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : " ") + text_of(value);
  return text;
}

/// The placeholder for a value in the help.
inline const char* kind_of_words(const std::string&) {
  return "TEXT";
}
inline const char* kind_of_words(double) {
  return "NUMBER";
}
inline const char* kind_of_words(int) {
  return "COUNT";
}
template <class T>
const char* kind_of_words(const std::optional<T>&) {
  return kind_of_words(T());
}
template <class T>
const char* kind_of_words(const std::vector<T>&) {
  return kind_of_words(T());
}

template <class T>
constexpr bool takes_several(const T&) {
  return false;
}
template <class T>
constexpr bool takes_several(const std::vector<T>&) {
  return true;
}

// ---------------------------------------------------------------- options

/// A parameter of a command: an option with words, a flag (an option without words), or an argument (a word without an
/// option's name).
class Option {
 public:
  /// Stores the value of the words. @returns what is wrong with them, or ""
  using Read = std::function<std::string(const Words& words)>;

  /// Adds a check that each word must pass.
  Option& check(Check check);
  /// Limits each word to these choices, which help and completion list.
  Option& choices(Words choices);
  /// Sets the placeholder for the words in the help.
  Option& shown_as(const std::string& words);
  /// Shows the default value in the help.
  Option& shows_default();
  /// Splits words at commas.
  Option& with_commas();
  /// Sets the exact number of words. By default it is one or, if the value is a vector, one or more.
  Option& takes(int words);
  /// The option is an error without the other option.
  Option& needs(const std::string& other);
  /// The option is an error together with the other option.
  Option& excludes(const std::string& other);

 private:
  friend class Command;
  enum class Number { None, One, Several };  // number of words

  std::string name_;        // "--output"; for an argument "scene"
  std::string short_name_;  // "-o"; usually empty
  std::string help_, heading_, default_, shown_as_;
  Number number_ = Number::One;
  int exactly_ = 0;  // number of words; 0: see number_
  bool shows_default_ = false, has_commas_ = false;
  Words choices_, needs_, excludes_;
  std::vector<Check> checks_;
  Read read_;

  bool has_few_choices() const;
  /// The words as the help shows them.
  std::string value_text() const;
  std::string help_text() const;
  /// Takes the words of all occurrences of the option. @returns what is wrong with them, or ""
  std::string take(const std::vector<Words>& occurrences) const;
};

/// A word that may come next on the command line, and its meaning.
struct Completion {
  std::string word, help;
};
/// Those of `all` that begin with `typed`.
std::vector<Completion> completions_of(const std::string& typed, const std::vector<Completion>& all);

// ---------------------------------------------------------------- commands

class Command {
 public:
  /// @param full_name  of the program and the command: "flexarm simulate"
  Command(std::string full_name, std::string description);

  /// Starts a heading in the help, for the options that follow.
  void heading(const std::string& heading) { heading_ = heading; }

  // Declared options and arguments keep references to their values, which must outlive the command.

  /// An argument. Arguments are expected in the order of their declaration.
  Option& argument(const std::string& name, std::string& value, const std::string& help);
  /// @param names  "--output", or "-o,--output"
  template <class T>
  Option& option(const std::string& names, T& value, const std::string& help) {
    return add(names, help, takes_several(value) ? Option::Number::Several : Option::Number::One, kind_of_words(value),
               text_of(value), [&value](const Words& words) { return read_words(words, value); });
  }
  /// An option whose words `read` interprets.
  Option& option_of_words(const std::string& names, Option::Read read, const std::string& help);
  Option& flag(const std::string& name, bool& value, const std::string& help);
  Option& flag(const std::string& name, const std::function<void()>& action, const std::string& help);

  /// Sets the function that runs the command and returns the exit status.
  void runs(std::function<int()> run) { run_ = std::move(run); }

  /// Parses the words and runs the command, or prints its help if the words ask for that.
  /// @throws InputError if the words are not as declared
  int run(const Words& words) const;

  const std::string& description() const { return description_; }
  /// What the last one of `words` may be completed to. Empty: it may be any text or file.
  std::vector<Completion> complete(const Words& words) const;

 private:
  Option& add(const std::string& names, const std::string& help, Option::Number number, const std::string& shown_as,
              const std::string& default_text, Option::Read read);
  const Option* find(const std::string& name) const;
  void print_help() const;
  struct Described;
  struct Typed;
  Typed take_apart(const Words& words) const;
  void leave_arguments(Typed& typed) const;
  void require_arguments(const Typed& typed) const;
  void require_good_company(const Typed& typed) const;
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_unknown(const std::string& token) const;

  std::string full_name_, description_, heading_ = "Options";
  std::deque<Option> arguments_, options_;  // deques, since references to their elements are kept
  std::function<int()> run_;
};

}  // namespace flexarm::cli
