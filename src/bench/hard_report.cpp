// Writes the results of hard cases as text.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "bench/hard.h"
#include "bench/markdown_table.h"
#include "bench/median.h"

namespace flexarm::bench {
namespace {

constexpr int kManyIterations = 10;  // per step

const char* to_string(HardOutcome::End end) {
  switch (end) {
    case HardOutcome::End::Completed:
      return "completed";
    case HardOutcome::End::Refused:
      return "refused";
    case HardOutcome::End::Failed:
      return "failed";
    case HardOutcome::End::OutOfTime:
      return "out of time";
    case HardOutcome::End::OutOfMemory:
      return "out of memory";
    case HardOutcome::End::Crashed:
      return "crashed";
  }
  return "unknown";
}

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::Right:
      return "right";
    case Verdict::Warned:
      return "warned";
    case Verdict::Wrong:
      return "wrong";
    case Verdict::LeftOut:
      return "left out";
    case Verdict::Failed:
      return "failed";
    case Verdict::Diagnosed:
      return "diagnosed";
    case Verdict::Unnoticed:
      return "unnoticed";
    case Verdict::Undiagnosed:
      return "undiagnosed";
  }
  return "unknown";
}

bool is_right(const HardRow& row, std::size_t scheme) {
  return verdict(row.hard, row.outcomes[scheme]) == Verdict::Right;
}

bool is_complete(const HardRow& row, std::size_t scheme) {
  return row.outcomes[scheme].end == HardOutcome::End::Completed;
}

template <class Predicate>
long count_rows(const HardReport& report, const Predicate& predicate) {
  return std::count_if(report.rows.begin(), report.rows.end(), predicate);
}

/// A number, or a dash for NaN.
std::string number(const char* format, double value) {
  return std::isnan(value) ? "–" : fmt::vformat(format, fmt::format_args(fmt::make_format_args(value)));
}

/// A row that sums up the results of one scheme, also relative to the first scheme.
std::string total_row(const HardReport& report, std::size_t s) {
  const auto of = [&](Verdict wanted) {
    return count_rows(report, [&](const HardRow& row) { return verdict(row.hard, row.outcomes[s]) == wanted; });
  };
  const auto ended = [&](HardOutcome::End end) {
    return count_rows(report, [&](const HardRow& row) { return row.outcomes[s].end == end; });
  };
  const auto beats = [&](std::size_t one, std::size_t other) {
    return count_rows(report, [&](const HardRow& row) {
      return row.hard.is_sound && is_complete(row, one) && !is_complete(row, other) &&
             verdict(row.hard, row.outcomes[other]) != Verdict::LeftOut;
    });
  };
  std::vector<double> iterations;
  double seconds = 0, energy_defect = 0, momentum_defect = 0;
  for (const HardRow& row : report.rows) {
    const HardOutcome& outcome = row.outcomes[s];
    seconds += outcome.seconds;
    if (!is_right(row, s)) continue;
    if (row.hard.load_steps == 0) iterations.push_back(outcome.iterations_per_step());
    energy_defect = std::max(energy_defect, outcome.energy_defect);
    momentum_defect = std::fmax(momentum_defect, outcome.momentum_defect);  // NaN for some cases
  }
  return row({report.options.schemes[s], std::to_string(of(Verdict::Right)), std::to_string(of(Verdict::Warned)),
              std::to_string(of(Verdict::Wrong)), std::to_string(of(Verdict::Failed)),
              std::to_string(of(Verdict::Diagnosed)), std::to_string(of(Verdict::Undiagnosed)),
              std::to_string(of(Verdict::Unnoticed)), std::to_string(ended(HardOutcome::End::OutOfTime)),
              std::to_string(ended(HardOutcome::End::Crashed) + ended(HardOutcome::End::OutOfMemory)),
              std::to_string(beats(s, 0)), std::to_string(beats(0, s)), number("{:.1f}", median(iterations)),
              fmt::format("{:.0e}", energy_defect), fmt::format("{:.0e}", momentum_defect),
              fmt::format("{:.1f}", seconds)});
}

std::string total_table(const HardReport& report) {
  const long sound = count_rows(report, [](const HardRow& row) { return row.hard.is_sound; });
  const std::string& first = report.options.schemes.front();
  std::string text = head({"scheme", fmt::format("right, of {} sound", sound), "wrong, warned", "wrong", "failed",
                           fmt::format("diagnosed, of {} unsound", report.rows.size() - sound), "without a reason",
                           "unnoticed", "out of time", "crashed", fmt::format("completes, `{}` does not", first),
                           fmt::format("`{}` completes, this does not", first), "iterations per step", "energy defect",
                           "momentum defect", "seconds"});
  for (std::size_t s = 0; s < report.options.schemes.size(); ++s) text += total_row(report, s);
  return text;
}

/// How far a run came, and why it went no further.
std::string ending(const HardCase& hard, const HardOutcome& outcome) {
  const std::string reason = outcome.reason.data();
  if (outcome.end == HardOutcome::End::Failed && hard.load_steps == 0)
    return fmt::format("{:.3g} s: {}", outcome.time, reason);
  return fmt::format("{}: {}", to_string(outcome.end), reason);
}

/// The iterations per step of a correct run; for other runs, what is wrong.
std::string cell(const HardCase& hard, const HardOutcome& outcome) {
  switch (verdict(hard, outcome)) {
    case Verdict::Right:
      return fmt::format("{:.1f}", outcome.iterations_per_step());
    case Verdict::Warned:
      return fmt::format("**warned** {:.1f}", outcome.iterations_per_step());
    case Verdict::Wrong:
      return fmt::format("**wrong** {:.1f}", outcome.iterations_per_step());
    case Verdict::LeftOut:
      return "–";
    case Verdict::Failed:
      if (outcome.end != HardOutcome::End::Failed || hard.load_steps > 0)
        return fmt::format("**{}**", to_string(outcome.end));
      return fmt::format("**✗** {:.0f} %", 100 * outcome.time / hard.until);
    case Verdict::Diagnosed:
      return "diagnosed";
    case Verdict::Unnoticed:
      return "**unnoticed**";
    case Verdict::Undiagnosed:
      return "**no reason**";
  }
  return "";
}

std::string group_table(const HardReport& report, const std::string& group) {
  std::vector<std::string> columns = {"case", "step [s]", "steps"};
  for (const std::string& scheme : report.options.schemes) columns.push_back("`" + scheme + "`");
  std::string text = fmt::format("\n## {}\n\n{}", group, head(columns));
  for (const HardRow& r : report.rows) {
    if (r.hard.group != group) continue;
    const long steps = r.hard.load_steps > 0 ? r.hard.load_steps : std::lround(r.hard.until / r.hard.step);
    std::vector<std::string> cells = {r.hard.is_sound ? r.hard.name : "*" + r.hard.name + "*",
                                      r.hard.load_steps > 0 ? "static" : fmt::format("{:.3g}", r.hard.step),
                                      std::to_string(steps)};
    for (const HardOutcome& outcome : r.outcomes) cells.push_back(cell(r.hard, outcome));
    text += row(cells);
  }
  return text;
}

/// Replaces characters that would end a cell or a line in Markdown.
std::string in_one_cell(std::string text) {
  std::replace(text.begin(), text.end(), '|', '/');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string trouble_table(const HardReport& report) {
  std::string text = head({"case", "what happened", "iterations: mean, largest", "halvings", "energy defect", "error"});
  for (const HardRow& r : report.rows) {
    const HardOutcome& outcome = r.outcomes.front();
    const Verdict v = verdict(r.hard, outcome);
    if (v == Verdict::Right || v == Verdict::Diagnosed || v == Verdict::LeftOut) continue;
    const std::string what = v == Verdict::Wrong       ? flaw(r.hard, outcome)
                             : v == Verdict::Warned    ? flaw(r.hard, outcome) + "; warned: " + outcome.warning.data()
                             : v == Verdict::Unnoticed ? "completed without a warning"
                                                       : ending(r.hard, outcome);
    text += row({r.hard.group + ": " + r.hard.name, in_one_cell(what),
                 fmt::format("{:.1f}, {}", outcome.iterations_per_step(), outcome.most_iterations),
                 std::to_string(outcome.halvings), fmt::format("{:.1e}", outcome.energy_defect),
                 number("{:.1e}", outcome.error)});
  }
  return text;
}

/// Correct runs of the first scheme with more than kManyIterations per step.
std::string dear_table(const HardReport& report) {
  std::string text = head({"case", "iterations: mean, largest", "steps", "halvings"});
  for (const HardRow& r : report.rows) {
    const HardOutcome& outcome = r.outcomes.front();
    if (verdict(r.hard, outcome) == Verdict::Right && outcome.iterations_per_step() > kManyIterations)
      text += row({r.hard.group + ": " + r.hard.name,
                   fmt::format("{:.1f}, {}", outcome.iterations_per_step(), outcome.most_iterations),
                   std::to_string(outcome.steps), std::to_string(outcome.halvings)});
  }
  return text;
}

std::string quoted(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return "\"" + text + "\"";
}

std::vector<std::string> groups(const HardReport& report) {
  std::vector<std::string> names;
  for (const HardRow& row : report.rows)
    if (std::find(names.begin(), names.end(), row.hard.group) == names.end()) names.push_back(row.hard.group);
  return names;
}

}  // namespace

std::string to_markdown(const HardReport& report, const std::string& picture) {
  const std::string& first = report.options.schemes.front();
  std::string text = fmt::format(
      "# Hard cases\n\nWritten by `flexarm bench hard`{}. {} scenes at which a simulator may fail, with the default"
      " options of a scene. Each run is a process of its own, limited to {} s of processor time and {:.1f} GiB.\n\n"
      "A run is *right* if all of this holds. It completes. Its end agrees with a closed form or a finer run. It "
      "stays within the bounds of its case. Its energy account gains less than 5 % of the motion's largest "
      "energy, and loses at most all of it; with contact it gains at most 1e-4, with and without the dissipated "
      "energy. The momenta of a free motion change by less than 5 %. Schemes that do not support contacts or "
      "lines skip these cases. A *warned* run is not right either, but it ends with a warning that names the "
      "bound that was exceeded: rotations per step, strains, the energy account. *Unsound* scenes (names in "
      "italics) cannot be built, have no definite motion, or have far too coarse a mesh. They must be refused, "
      "or end with a reason that says more than that the iteration did not converge.\n\n",
      report.options.quick ? " `--quick`: first steps only" : "", report.rows.size(), report.options.limits.seconds,
      static_cast<double>(report.options.limits.bytes) / (1 << 30));
  text += total_table(report);
  text +=
      "\nOver the right runs in time: the median of the iterations per step, the largest change of the energy "
      "account relative to the largest energy, and that of the momenta of free motions relative to their own size. "
      "Seconds: processor time of all runs together.\n";
  if (!picture.empty()) text += fmt::format("\n![Cases and schemes]({})\n", picture);
  text += fmt::format("\n## Not right with `{}`\n\n{}", first, trouble_table(report));
  text += fmt::format("\n## Right with `{}`, but with more than {} iterations a step\n\n{}", first, kManyIterations,
                      dear_table(report));
  text +=
      "\nBelow: Newton iterations per step of right runs; for the others, the part of the motion that they "
      "completed. Halvings, defects, errors, times and reasons of every run are in [hard.csv](hard.csv).\n";
  for (const std::string& group : groups(report)) text += group_table(report, group);
  return text;
}

std::string hard_to_csv(const HardReport& report) {
  std::string text =
      "group,case,sound,scheme,verdict,end,part,time,steps,iterations,most_iterations,halvings,energy_gain,"
      "energy_defect,momentum_defect,bound,error,seconds,reason\n";
  for (const HardRow& row : report.rows)
    for (std::size_t s = 0; s < row.outcomes.size(); ++s) {
      const HardOutcome& o = row.outcomes[s];
      const bool is_whole = o.end == HardOutcome::End::Completed || row.hard.load_steps > 0;
      const std::string why = o.end == HardOutcome::End::Completed ? flaw(row.hard, o) : o.reason.data();
      text += fmt::format(
          "{},{},{:d},{},{},{},{:.4g},{:.6g},{},{:.4g},{},{},{:.3g},{:.3g},{:.3g},{:.4g},{:.3g},{:.3g},{}\n",
          quoted(row.hard.group), quoted(row.hard.name), row.hard.is_sound, report.options.schemes[s],
          to_string(verdict(row.hard, o)), to_string(o.end), is_whole ? 1 : o.time / row.hard.until, o.time, o.steps,
          o.iterations_per_step(), o.most_iterations, o.halvings, o.energy_gain, o.energy_defect, o.momentum_defect,
          o.bound, o.error, o.seconds, quoted(why));
    }
  return text;
}

}  // namespace flexarm::bench
