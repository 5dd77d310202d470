// Tests sections along a beam: as stations in the scene, and as a table in another file.
#include <gtest/gtest.h>

#include "scene_text.h"

namespace flexarm::scene {
namespace {

const std::string kTube = R"(<tube outer_radius="0.02" inner_radius="0.01"/>)";
const std::string kMaterial = R"(<material young="70e9" poisson="0.33" density="2700"/>)";

const Section& forearm_section(const ReadResult& result) {
  return result.scene->links[2].beam->section;
}

TEST(Stations, ShapesShareTheMaterial) {
  const ReadResult result = read(good_scene_with(kTube, R"(<stations><station at="0"><circle radius="0.02"/></station>
                <station at="1.5"><circle radius="0.01"/></station></stations>)"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const SectionStations& stations = std::get<SectionStations>(forearm_section(result));
  EXPECT_EQ(stations.arc_lengths, (std::vector<double>{0, 1.5}));
  ASSERT_EQ(stations.sections.size(), 2u);
  const GeometricSection& last = std::get<GeometricSection>(stations.sections[1]);
  EXPECT_EQ(std::get<Circle>(last.shape).radius, 0.01);
  EXPECT_EQ(last.material.young, 70e9);
}

ReadResult read_with(const std::string& table) {
  std::string text = good_scene_with(kTube, R"(<stations file="flexarm_blade.csv"/>)");
  text.erase(text.find(kMaterial), kMaterial.size());
  return read_with_table(text, "flexarm_blade.csv", table);
}

void expect_table_error(const std::string& table, const std::string& fragment) {
  const ReadResult result = read_with(table);
  EXPECT_FALSE(result.scene) << table;
  EXPECT_NE(to_text(result.diagnostics).find(fragment), std::string::npos) << to_text(result.diagnostics);
}

const std::string kDirectHeader = "at,ea,ga2,ga3,gj,ei2,ei3,mass,j1,j2,j3\n";

TEST(SectionTable, DirectStiffnesses) {
  const ReadResult result =
      read_with("mass, at,ea,ga2,ga3,gj,ei2,ei3,j1,j2,j3\r\n7,0,1,2,3,4,5,6,8,9,10\r\n\n14,2,2,4,6,8,10,12,16,18,20\n");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const SectionStations& stations = std::get<SectionStations>(forearm_section(result));
  EXPECT_EQ(stations.arc_lengths, (std::vector<double>{0, 2}));
  EXPECT_EQ(std::get<DirectSection>(stations.sections[0]).ei3, 6);
  EXPECT_EQ(std::get<DirectSection>(stations.sections[1]).mass, 14);
}

/// Returns a table of two stations with the same matrices, given by entry(letter, row, column).
template <class Entry>
std::string matrix_table(const Entry& entry) {
  std::string header = "at", row;
  for (const char letter : {'k', 'm'})
    for (int i = 1; i <= 6; ++i)
      for (int j = i; j <= 6; ++j) {
        header += std::string(",") + letter + std::to_string(i) + std::to_string(j);
        row += "," + std::to_string(entry(letter, i, j));
      }
  return header + "\n0" + row + "\n1" + row + "\n";
}

/// A good matrix: coupling k15, and a mass of 2 per length on the centreline.
int good_entry(char letter, int i, int j) {
  if (i != j) return letter == 'k' && i == 1 && j == 5 ? 3 : 0;
  return letter == 'k' ? 10 : i <= 3 ? 2 : 1;
}

TEST(SectionTable, Matrices) {
  const ReadResult result = read_with(matrix_table(good_entry));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const auto& section = std::get<MatrixSection>(std::get<SectionStations>(forearm_section(result)).sections[1]);
  EXPECT_EQ(section.stiffness(0, 4), 3);
  EXPECT_EQ(section.stiffness(4, 0), 3);
  EXPECT_EQ(section.inertia(2, 2), 2);
}

TEST(SectionTable, ImpossibleMatrices) {
  const auto with = [](char letter, int row, int column, int value) {
    return matrix_table(
        [=](char l, int i, int j) { return l == letter && i == row && j == column ? value : good_entry(l, i, j); });
  };
  expect_table_error(with('k', 1, 5, 10), "blade.csv:2: the stiffness k11 to k66 must be positive definite");
  const std::string inertia = "blade.csv:2: the inertia m11 to m66 must be [[m 1, -m d^], [m d^, J]]";
  expect_table_error(with('m', 1, 1, 3), inertia);  // the mass along x differs from the mass along y
  expect_table_error(with('m', 1, 4, 1), inertia);  // no offset of the centre of mass causes such a moment
}

TEST(SectionTable, Errors) {
  const std::string row = ",1,2,3,4,5,6,7,8,9,10\n";
  expect_table_error("", "blade.csv:1: the columns ea, ga2");
  expect_table_error("at,ea\n0,1\n", "blade.csv:1: the columns ea, ga2");
  expect_table_error(kDirectHeader, "at least two stations are expected");
  expect_table_error(kDirectHeader + "0" + row, "at least two stations are expected");
  expect_table_error(kDirectHeader + "0" + row + "0" + row,
                     "blade.csv:3: at must be > 0, the value of the line before, got '0'");
  expect_table_error(kDirectHeader + "-1" + row, "blade.csv:2: at must be >= 0, got '-1'");
  expect_table_error(kDirectHeader + "0" + row + "1,1,2,3\n", "blade.csv:3: 11 numbers are expected, got '4'");
  expect_table_error(kDirectHeader + "0,1,2,3,4,5,6,7,8,9,nan\n", "blade.csv:2: j3 must be a finite number, got 'nan'");
  expect_table_error(kDirectHeader + "0,1,2,3,0,5,6,7,8,9,10\n", "blade.csv:2: gj must be > 0, got '0'");
}

}  // namespace
}  // namespace flexarm::scene
