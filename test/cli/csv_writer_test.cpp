/// Tests the CSV writer: its rows are read back, also with a foreign locale, odd names and a disk that is full.
#include "flexarm/simulation/csv_writer.h"

#include <locale>

#include "cli/program.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm::cli {
namespace {

Simulation simulation(const std::string& joint) {
  const std::string text = R"(<robot name="r"> <link name="world"/>
    <joint name=")" + joint +
                           R"(" type="prismatic"> <parent link="world"/> <child link="cart"/>
      <limit lower="-1" upper="1" effort="0" velocity="0"/> </joint>
    <link name="cart">
      <inertial> <mass value="2"/> <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial>
    </link>
    <simulation> <initial joint=")" +
                           joint + R"(" position="0.1" velocity="0.5"/> </simulation> </robot>)";
  const scene::ReadResult result = scene::read_scene_text(text, "scene.urdf");
  EXPECT_TRUE(result.scene) << scene::to_text(result.diagnostics);
  return Simulation(result.scene.value());
}

std::string written(const Simulation& simulation, ResultColumns::Solver solver) {
  const std::string path = temporary("out.csv");
  CsvWriter writer(path, ResultColumns(simulation, solver));
  writer.write_row(simulation);
  writer.close();
  return read_file(path);
}

/// Groups digits and has a decimal comma.
struct Foreign : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

}  // namespace

TEST(CsvWriter, WritesTheState) {
  const std::string path = temporary("out.csv");
  const Simulation cart = simulation("rail");
  CsvWriter writer(path, ResultColumns(cart, ResultColumns::Solver::Without));
  writer.write_row(cart);
  writer.write_row(cart);
  writer.close();
  Columns columns = read_csv(path);
  EXPECT_EQ(columns["time"], (std::vector<double>{0, 0}));
  EXPECT_EQ(columns["joint/rail/position"][0], 0.1);
  EXPECT_EQ(columns["frame/cart/x"][0], 0.1);
  EXPECT_EQ(columns["frame/cart/qw"][0], 1);
  EXPECT_NEAR(columns["joint/rail/velocity"][0], 0.5, 1e-15);
  EXPECT_NEAR(columns["energy/kinetic"][0], 0.25, 1e-15);
  EXPECT_NEAR(columns["momentum/x"][0], 1, 1e-15);
  EXPECT_EQ(columns.count("solver/step"), 0u);
}

TEST(CsvWriter, SolverCountsStartAgainAfterEachRow) {
  const std::string path = temporary("out.csv");
  const Simulation cart = simulation("rail");
  CsvWriter writer(path, ResultColumns(cart, ResultColumns::Solver::With));
  StepResult step;
  step.iterations = 3;
  step.halvings = 1;
  step.deepest_halving = 2;
  writer.note_step(cart, step);
  step.deepest_halving = 1;
  step.is_dissipated = true;
  writer.note_step(cart, step);
  writer.write_row(cart);
  writer.write_row(cart);
  writer.close();
  Columns columns = read_csv(path);
  EXPECT_EQ(columns["solver/step"], (std::vector<double>{1e-3, 1e-3}));
  EXPECT_EQ(columns["solver/iterations"], (std::vector<double>{6, 0}));
  EXPECT_EQ(columns["solver/halvings"], (std::vector<double>{2, 0}));
  EXPECT_EQ(columns["solver/deepest_halving"], (std::vector<double>{2, 0}));
  EXPECT_EQ(columns["solver/other_guesses"], (std::vector<double>{0, 0}));
  EXPECT_EQ(columns["solver/dissipated_steps"], (std::vector<double>{1, 0}));
}

TEST(CsvWriter, DoesNotDependOnTheLocale) {
  const Simulation cart = simulation("rail");
  const std::string text = written(cart, ResultColumns::Solver::With);
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Foreign));
  EXPECT_EQ(written(cart, ResultColumns::Solver::With), text);
  std::locale::global(before);
}

TEST(CsvWriter, NamesWithSeparatorsStandInQuotes) {
  const std::string text = written(simulation("a,b"), ResultColumns::Solver::Without);
  EXPECT_NE(text.find(",\"joint/a,b/position\","), std::string::npos) << text;
}

TEST(CsvWriter, ReportsErrors) {
  const Simulation cart = simulation("rail");
  EXPECT_THROW(CsvWriter("/no/such/folder/out.csv", ResultColumns(cart, ResultColumns::Solver::Without)),
               std::runtime_error);
  EXPECT_THROW(CsvWriter("/dev/full", ResultColumns(cart, ResultColumns::Solver::Without)), std::runtime_error);
}

}  // namespace flexarm::cli
