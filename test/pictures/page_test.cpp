// Tests files of pages, and recordings of many instants.
#include "pictures/page.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <regex>

#include "pictures/still_pictures.h"
#include "scene/scene_builder.h"

namespace flexarm::pictures {
namespace {

Simulation pendulum() {
  scene::SceneBuilder b("pendulum");
  b.body("rod", 1, {0.5, 0, 0}, 0.1 * Matrix3::Identity());
  b.joint("hinge", scene::JointKind::Continuous, "world", "rod").axis = Vector3::UnitY();
  return Simulation(b.scene);
}

std::string content_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(PageWriter, ReplacesAnOlderPageOnlyWhenTheRunIsComplete) {
  const std::string path = ::testing::TempDir() + "flexarm_page_test.html";
  std::ofstream(path) << "older";
  const Simulation simulation = pendulum();
  {
    PageWriter writer(path, simulation, {"new"});
    writer.write_row(simulation);
    EXPECT_EQ(content_of(path), "older");
  }
  EXPECT_EQ(content_of(path), "older");  // without close(), as after an error
  PageWriter writer(path, simulation, {"new"});
  writer.write_row(simulation);
  writer.close();
  EXPECT_NE(content_of(path).find("flexarm-motion"), std::string::npos);
  std::remove(path.c_str());
}

TEST(PageWriter, NamesAFileThatCannotBeWrittenBeforeTheRun) {
  const std::string path = ::testing::TempDir() + "no_such_folder/page.html";
  try {
    PageWriter(path, pendulum(), {"page"});
    FAIL() << "it could be written";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
  }
}

// With 49 instants each, so many modes have more instants than a run may have.
TEST(Modes, OfAnyNumberKeepTheirClips) {
  const Simulation simulation = pendulum();
  const Mode mode = simulation.natural_modes(1).front();
  const std::vector<NamedMode> modes(450, {"mode", mode});
  const std::string json = record_modes(simulation, modes, "modes").picture;
  const std::regex clip("\"first\": (\\d+), \"count\": (\\d+)");
  std::size_t next = 1, count = 0;
  for (std::sregex_iterator found(json.begin(), json.end(), clip), none; found != none; ++found, ++count) {
    EXPECT_EQ(std::stoul((*found)[1]), next);
    EXPECT_EQ(std::stoul((*found)[2]), 49u);
    next += 49;
  }
  EXPECT_EQ(count, modes.size());
  EXPECT_NE(json.find("\"frames\": " + std::to_string(next)), std::string::npos);
}

}  // namespace
}  // namespace flexarm::pictures
