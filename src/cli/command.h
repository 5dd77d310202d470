#pragma once
/// A command and its options, declared once: for what is typed (taken apart by Boost), for help and for completion.

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flexarm::cli {

using Words = std::vector<std::string>;

// ---------------------------------------------------------------- words

/// What is wrong with a word; empty: nothing.
using Check = std::function<std::string(const std::string& word)>;

Check whole_number_between(int least, int most);
/// A finite number > 0, or >= 0.
std::string check_positive(const std::string& word);
std::string check_non_negative(const std::string& word);
/// A file that is there.
std::string check_existing_file(const std::string& word);

/// Takes words as a value; returns what is wrong with them.
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

/// A value as it is typed.
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

/// What stands for a value in the help.
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

/// What a command takes: an option with its words, a flag, which has none, or an argument, which has no name.
class Option {
 public:
  /// Keeps the words, or says what is wrong with them.
  using Read = std::function<std::string(const Words& words)>;

  /// Each word must pass.
  Option& check(Check check);
  /// Each word is one of these; help and completion list them.
  Option& choices(Words choices);
  /// In the help, in the place of the kind of its words.
  Option& shown_as(const std::string& words);
  /// What it is without this option is in the help.
  Option& shows_default();
  /// A word may be several, with commas between them.
  Option& with_commas();
  /// It is followed by so many words; else by one, or by one or more where its value is a vector.
  Option& takes(int words);
  /// It is of no use without that other option.
  Option& needs(const std::string& other);
  /// Not both.
  Option& excludes(const std::string& other);

 private:
  friend class Command;
  enum class Number { None, One, Several };  // of words

  std::string name_;        // "--output"; of an argument "scene"
  std::string short_name_;  // "-o"; mostly empty
  std::string help_, heading_, default_, shown_as_;
  Number number_ = Number::One;
  int exactly_ = 0;  // words; 0: as number_ says
  bool shows_default_ = false, has_commas_ = false;
  Words choices_, needs_, excludes_;
  std::vector<Check> checks_;
  Read read_;

  bool has_few_choices() const;
  /// As the help has them.
  std::string value_text() const;
  std::string help_text() const;
  /// What is wrong with what was typed, how often that may be.
  std::string take(const std::vector<Words>& occurrences) const;
};

/// What may be typed next, and what it does.
struct Completion {
  std::string word, help;
};
/// Those that begin as what is typed does.
std::vector<Completion> completions_of(const std::string& typed, const std::vector<Completion>& all);

// ---------------------------------------------------------------- commands

class Command {
 public:
  /// `full_name` is that of the program, and its own: "flexarm simulate".
  Command(std::string full_name, std::string description);

  /// Options that follow stand below this heading in the help.
  void heading(const std::string& heading) { heading_ = heading; }

  // What is declared here keeps references to its values, which must outlive the command.

  /// A word without a name; they are expected in the order in which they are declared.
  Option& argument(const std::string& name, std::string& value, const std::string& help);
  /// `names`: "--output", or "-o,--output".
  template <class T>
  Option& option(const std::string& names, T& value, const std::string& help) {
    return add(names, help, takes_several(value) ? Option::Number::Several : Option::Number::One, kind_of_words(value),
               text_of(value), [&value](const Words& words) { return read_words(words, value); });
  }
  /// Whose words mean something else than a value.
  Option& option_of_words(const std::string& names, Option::Read read, const std::string& help);
  Option& flag(const std::string& name, bool& value, const std::string& help);
  Option& flag(const std::string& name, const std::function<void()>& action, const std::string& help);

  /// What it does; returns the exit status.
  void runs(std::function<int()> run) { run_ = std::move(run); }

  /// Takes the words and runs, or prints its help where they ask for that.
  /// @throws InputError where they are not what is expected.
  int run(const Words& words) const;

  const std::string& description() const { return description_; }
  /// What the last one of `words` may become; nothing: any text or file.
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
  std::deque<Option> arguments_, options_;  // which others hold by reference
  std::function<int()> run_;
};

}  // namespace flexarm::cli
