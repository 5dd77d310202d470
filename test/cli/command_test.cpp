/// Tests commands and options as they are declared in code: how typed words become values, errors, help and completion.

#include "cli/command.h"

#include "cli/exit_status.h"
#include "cli/program.h"
#include "flexarm/math/near_names.h"

namespace flexarm::cli {
namespace {

/// A command with one option of each kind.
struct Declared {
  Declared() {
    command.argument("scene", scene, "scene file");
    command.option("--until", until, "end time [s]").shows_default().check(check_non_negative);
    command.option("--step", step, "time step [s]").check(check_positive);
    command.option("--count", count, "how many").check(whole_number_between(1, 5));
    command.heading("Output");
    command.option("-o,--output", output, "file").shown_as("FILE");
    command.option("--columns", columns, "names").with_commas().needs("--output");
    command.option("--set", settings, "settings").shown_as("NAME=VALUE");
    command.option("--range", range, "two").takes(2).shown_as("FIRST COUNT");
    command.option("--law", law, "of friction").choices({"coulomb", "stribeck"});
    command.flag("--quiet", quiet, "says nothing").excludes("--law");
    command.runs([this] { return ++runs, kDone; });
  }
  /// Returns the error message, or an empty text if the command has run.
  std::string run(const Words& words) {
    try {
      EXPECT_EQ(command.run(words), kDone);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  std::string scene, output, law;
  double until = 10;
  std::optional<double> step;
  int count = 0, runs = 0;
  Words columns, settings;
  std::vector<int> range;
  bool quiet = false;
  Command command{"flexarm try", "Tries"};
};

}  // namespace

TEST(Command, TakesWordsAsValues) {
  Declared d;
  EXPECT_EQ(d.run({"--until", "2.5", "a.urdf", "--step=1e-3", "-o", "-", "--columns", "a,b", "c", "--range", "3", "4",
                   "--count", "5", "--law", "coulomb"}),
            "");
  EXPECT_EQ(d.runs, 1);
  EXPECT_EQ(d.scene, "a.urdf");
  EXPECT_EQ(d.until, 2.5);
  EXPECT_EQ(d.step, 1e-3);
  EXPECT_EQ(d.output, "-");
  EXPECT_EQ(d.columns, (Words{"a", "b", "c"}));
  EXPECT_EQ(d.range, (std::vector<int>{3, 4}));
  EXPECT_EQ(d.count, 5);
  EXPECT_EQ(d.law, "coulomb");
  EXPECT_FALSE(d.quiet);
}

TEST(Command, ListsLeaveTheArgumentsWhatTheyNeed) {
  for (const Words& words :
       {Words{"--set", "a=1", "b=2", "a.urdf"}, Words{"--set", "a=1", "b=2", "--", "a.urdf"},
        Words{"a.urdf", "--set", "a=1", "--set", "b=2"}, Words{"--set", "a=1", "--set", "b=2", "a.urdf"}}) {
    Declared d;
    EXPECT_EQ(d.run(words), "");
    EXPECT_EQ(d.scene, "a.urdf");
    EXPECT_EQ(d.settings, (Words{"a=1", "b=2"}));
  }
}

TEST(Command, SaysWhatIsWrong) {
  const std::pair<Words, const char*> cases[] = {
      {{}, "flexarm try: scene is missing: scene file\n'flexarm try --help' lists what is expected"},
      {{"a", "b"}, "unexpected 'b'"},
      {{"a", "--until", "-1"}, "--until: must be a number >= 0, got '-1'"},
      {{"a", "--until", "nan"}, "--until: must be a number >= 0, got 'nan'"},
      {{"a", "--step", "1x"}, "--step: must be a number > 0, got '1x'"},
      {{"a", "--until"}, "--until"},
      {{"a", "--until", "1", "--until", "2"}, "--until: must be given once"},
      {{"a", "--count", "6"}, "--count: must be a whole number from 1 to 5, got '6'"},
      {{"a", "--count", "1.5"}, "--count: must be a whole number from 1 to 5, got '1.5'"},
      {{"a", "--range", "3"}, "--range: must be followed by 2 words, got '3'"},
      {{"a", "--range", "3", "x"}, "--range: must be a whole number"},
      {{"a", "--columns", "x"}, "--columns needs --output"},
      {{"a", "--law", "coulomb", "--quiet"}, "--quiet excludes --law"},
      {{"a", "--law", "columb"}, "--law: must be one of coulomb, stribeck, got 'columb'; did you mean 'coulomb'?"},
      {{"a", "--quiet=1"}, "--quiet"},
      {{"a", "--unitl", "2"}, "there is no option '--unitl'; did you mean '--until'?"},
      {{"a", "--col"}, "there is no option '--col'; did you mean '--columns'?"},
      {{"a", "--abracadabra"}, "there is no option '--abracadabra'\n"},
      {{"a", "-x"}, "there is no option '-x'"},
  };
  for (const auto& [words, expected] : cases) {
    Declared d;
    expect_contains(d.run(words), expected);
    EXPECT_EQ(d.runs, 0);
  }
}

TEST(Command, HelpIsAlignedAndHasItsHeadings) {
  Declared d;
  testing::internal::CaptureStdout();
  EXPECT_EQ(d.run({"--help"}), "") << "whatever else is missing";
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_EQ(d.runs, 0);
  for (const char* text : {"Tries\nUsage: flexarm try [OPTIONS] scene\n", "\n  scene      scene file\n",
                           "\nOptions:\n  --until NUMBER (=10)", "\nOutput:\n  -o [ --output ] FILE",
                           "\n  --set NAME=VALUE ...", "\n  --law coulomb|stribeck"})
    expect_contains(help, text);
  const auto column_of = [&](const std::string& text) {
    const std::size_t at = help.find(text);
    return at - help.rfind('\n', at);
  };
  EXPECT_EQ(column_of("end time [s]"), column_of("says nothing"));
}

TEST(Command, Completes) {
  const Declared d;
  const auto completed = [&](const Words& words) {
    std::string out;
    for (const Completion& one : d.command.complete(words)) out += one.word + " ";
    return out;
  };
  EXPECT_EQ(completed({"--s"}), "--step --set ");
  EXPECT_EQ(completed({"a.urdf", "--law", ""}), "coulomb stribeck ");
  EXPECT_EQ(completed({"a.urdf", "--law", "s"}), "stribeck ");
  EXPECT_EQ(completed({"a"}), "") << "a file";
  EXPECT_EQ(completed({"--output", ""}), "") << "a file";
}

TEST(NearNames, AreWhatWasProbablyMeant) {
  EXPECT_EQ(misspellings("simulat", "simulate"), 1);
  EXPECT_EQ(misspellings("simualte", "simulate"), 1) << "swapped";
  EXPECT_EQ(misspellings("", "abc"), 3);
  EXPECT_EQ(misspellings("*tip*", "probe/tip/x"), 0);
  EXPECT_EQ(misspellings("joint/*/positoin", "joint/elbow/position"), 1);
  EXPECT_EQ(suggestion("chekc", {"simulate", "check"}), "; did you mean 'check'?");
  EXPECT_EQ(suggestion("lin", {"simulate", "linearise"}), "; did you mean 'linearise'?");
  EXPECT_EQ(suggestion("fly", {"simulate", "check"}), "");
  EXPECT_EQ(suggestion("fly", {}), "");
}

}  // namespace flexarm::cli
