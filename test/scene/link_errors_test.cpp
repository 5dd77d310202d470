/// Tests errors and warnings about links, inertias and beams.
#include "scene/scene_text.h"

namespace flexarm::scene {
TEST(LinkErrors, Inertial) {
  expect_error(R"(<mass value="2"/>)", R"(<mass value="-2"/>)", 16,
               "scene.urdf:16: <mass> of link 'upper': value must be >= 0, got '-2'");
  expect_error(R"(ixy="0")", R"(ixy="1e61")", 17, "ixy must be at most 1e60 in absolute value, got '1e61'");
  expect_error(R"(<mass value="2"/>)", R"(<mass value="2kg"/>)", 16, "value must be a finite number, got '2kg'");
  expect_error(R"(<mass value="2"/>)", R"(<mass value="nan"/>)", 16, "value must be a finite number, got 'nan'");
  expect_error(R"(<mass value="2"/>)", R"(<mass/>)", 16, "attribute 'value' is missing");
  expect_error(R"(<mass value="2"/>)", "", 14, "<inertial> of link 'upper': <mass> is missing");
  expect_error(R"(ixx="0.01")", R"(ixx="1e999")", 17, "ixx must be a finite number, got '1e999'");
  expect_error(R"(ixx="0.01")", "", 17, "<inertia> of link 'upper': attribute 'ixx' is missing");
  expect_error(R"(ixy="0")", R"(ixy="5")", 17, "principal moments of inertia must be >= 0");
  expect_error(R"(<origin xyz="0.1 0 0")", R"(<origin xyz="0.1 0")", 15, "xyz must be 3 finite numbers, got '0.1 0'");
}

TEST(LinkErrors, UnlikelyInertiaIsAWarning) {
  const ReadResult result = read(good_scene_with(R"(izz="0.025")", R"(izz="0.25")"));
  EXPECT_TRUE(result.scene);
  ASSERT_EQ(result.diagnostics.size(), 1u);
  EXPECT_EQ(result.diagnostics[0].severity, Diagnostic::Severity::Warning);
  EXPECT_EQ(result.diagnostics[0].line, 17);
}

TEST(LinkErrors, WhatOnlyOtherProgramsUseIsAWarning) {
  const auto expect = [](const std::string& from, const std::string& to, int line, const std::string& fragment) {
    expect_warning(read(good_scene_with(from, to)), line, fragment);
  };
  expect(R"(<box size="1 1 1"/>)", R"(<box size="1 1"/>)", 19,
         "<visual> of link 'upper': programs that use urdfdom cannot read it, got");
  expect(R"(<box size="1 1 1"/>)", R"(<bocks/>)", 19, "Unknown geometry type 'bocks'");
  expect(R"(<sphere radius="1"/>)", R"(<sphere radius="big"/>)", 20, "<collision> of link 'upper'");
  expect(R"(rgba="0.5 0.5 0.5 1")", R"(rgba="0.5 grey 0.5 1")", 3, "<material> of robot 'arm': programs that use");
  expect(R"(</geometry> <material name="grey"/> </visual>)", R"(</geometry> <material/> </visual>)", 19,
         "material must contain a name");
  expect(R"(<robot name="arm">)", R"(<robot name="arm" version="3.0">)", 1,
         "<robot>: programs that use urdfdom refuse this file, got");
  // urdfdom cannot read a line break inside the quotes of a number.
  expect("iyz=\"0\"", "iyz=\"0\n \"", 14, "<inertial> of link 'upper': programs that use urdfdom cannot read it");
}

/// urdfdom passes such texts to printf as formats, where %n writes and %s reads at arbitrary places.
TEST(LinkErrors, PercentSignsAreNoFormats) {
  for (const std::string sign : {"%", "&#37;", "&#x025;"}) {
    SCOPED_TRACE(sign);
    const std::string text = "1 " + sign + "s" + sign + "n 1";
    expect_warning(read(good_scene_with(R"(<box size="1 1 1"/>)", "<box size=\"" + text + "\"/>")), 19, "%s%n");
    expect_warning(read(good_scene_with(R"(<robot name="arm">)", R"(<robot name="arm" version=")" + text + "\">")), 1,
                   "programs that use urdfdom refuse this file");
  }
}

TEST(LinkErrors, NegativeMoments) {
  const std::string inertia = R"(<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.025"/>)";
  const auto diagonal = [](const std::string& xx, const std::string& yy, const std::string& zz) {
    return "<inertia ixx=\"" + xx + "\" ixy=\"0\" ixz=\"0\" iyy=\"" + yy + "\" iyz=\"0\" izz=\"" + zz + "\"/>";
  };
  // For a mass of 2 kg, a radius of gyration below a micrometre counts as zero.
  const double nothing = 2 * 1e-6 * 1e-6;
  const auto text = [&](double factor) { return std::to_string(-factor * nothing * 1e12) + "e-12"; };
  expect_warning(read(good_scene_with(inertia, diagonal(text(0.9), "0", "0"))), 17, "principal moments of inertia");
  expect_error(inertia, diagonal(text(1.1), "0", "0"), 17, "principal moments of inertia must be >= 0, got '-2.2e-12'");
  expect_error(inertia, diagonal("-0.001", "0.01", "0.01"), 17, "principal moments of inertia must be >= 0");
}

TEST(LinkErrors, NegativeMomentsOfALinkThatIsFixedToOthers) {
  // A mast of 1 kg, 1 m long, is joined to the hull. Its file gives the moment of inertia J about one axis.
  const auto scene = [](const std::string& type, const std::string& moment) {
    const auto inertial = [](const std::string& mass, const std::string& xx) {
      return "<inertial><mass value=\"" + mass + "\"/><inertia ixx=\"" + xx +
             "\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>";
    };
    return "<robot name=\"r\"><link name=\"world\"/><link name=\"hull\">" + inertial("1", "1") + "</link>\n" +
           "<link name=\"mast\">" + inertial("1", moment) + "</link>\n" +
           "<joint name=\"i\" type=\"continuous\"><parent link=\"world\"/><child link=\"hull\"/></joint>\n" +
           "<joint name=\"j\" type=\"" + type + "\"><origin xyz=\"0 0 1\"/><parent link=\"hull\"/>" +
           "<child link=\"mast\"/></joint></robot>";
  };
  // The combined moment about x: 1 + J + 2 * 1 kg * (1/2 m)^2.
  expect_warning(read(scene("fixed", "-1.499")), 2, "principal moments of inertia must be >= 0 (harmless");
  expect_one_error(scene("fixed", "-1.501"), 2, "principal moments of inertia must be >= 0");
  expect_one_error(scene("continuous", "-0.1"), 2, "principal moments of inertia must be >= 0");
}

TEST(LinkErrors, Names) {
  expect_error(R"(<link name="world"/>)", R"(<link name="world"/><link/>)", 4,
               "<link> of robot 'arm': attribute 'name' is missing");
  expect_error(R"(<link name="world"/>)", R"(<link name="world"/><link name="hand"/>)", 46,
               "<link> 'hand': name is taken, by line 4");
  EXPECT_FALSE(read(good_scene_with(R"(<link name="hand">)", R"(<link name="">)")).scene);
  EXPECT_FALSE(read(good_scene_with(R"(<link name="hand">)", "<link name=\"" + std::string(300, 'x') + "\">")).scene);
  EXPECT_FALSE(read(good_scene_with(R"(<link name="hand">)", R"(<link name="a&#10;b">)")).scene);
}

TEST(LinkErrors, BeamAndInertialGiveOneWarning) {
  const std::string inertial =
      R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";
  const ReadResult result = read(good_scene_with(R"(<link name="forearm">)", R"(<link name="forearm">)" + inertial));
  EXPECT_TRUE(result.scene);
  ASSERT_EQ(result.diagnostics.size(), 1u);
  EXPECT_EQ(
      result.diagnostics[0].text(),
      "scene.urdf:27: warning: <inertial> of link 'forearm': is ignored, since the mass of a flexible link comes from "
      "its <beam>");
}

TEST(BeamErrors, Structure) {
  expect_error(R"(<orientation y="0 2 0"/>)", R"(<orientation y="0 2 0"/><foo/>)", 33,
               "<foo> of beam 'forearm': unknown element, expected centerline, orientation");
  expect_error(R"(order="3")", R"(degree="3")", 28,
               "<beam> of link 'forearm': unknown attribute, expected elements, order, refine, got 'degree'");
  expect_error(R"(<orientation y="0 2 0"/>)", "text", 33, "no text is expected here, got 'text'");
  expect_error(R"(<orientation y="0 2 0"/>)", R"(<damping mass_proportional="1"/>)", 36, "at most one <damping>");
  expect_error(R"(<tube outer)", R"(<tube colour="red" outer)", 34,
               "unknown attribute, expected outer_radius, inner_radius, got 'colour'");
  expect_error(R"(<link name="world"/>)", R"(<link name="world"/><beam/>)", 4, "<beam> must be a child of <link>");
  expect_error("</beam>\n  </link>\n  <joint", "</beam><beam/>\n  </link>\n  <joint", 37, "at most one <beam>");
}

TEST(BeamErrors, ElementsAndOrder) {
  for (const char* bad : {"-1", "2.5", "many", "", "100001", "99999999999999999999"})
    expect_error(R"(elements="4")", "elements=\"" + std::string(bad) + "\"", 28,
                 "elements must be a whole number from 0 to 100000 or 'auto', got '" + std::string(bad) + "'");
  for (const char* bad : {"0", "5", "2nd"})
    expect_error(R"(order="3")", "order=\"" + std::string(bad) + "\"", 28, "order must be a whole number from 1 to 4");
}

TEST(BeamErrors, Centreline) {
  const std::string line = R"(<line to="1 0 0" twist="0.5"/>)", arc = R"(<arc to="2 1 0" center="1 1 0"/>)";
  expect_error(line, R"(<line to="0 0 0"/>)", 30, "<line> of beam 'forearm': the line must have a length");
  expect_error(line, R"(<line to="1e30 0 0"/>)", 30, "the line must have a length between 0 and");
  expect_error(line, R"(<line to="1 0 x"/>)", 30, "to must be 3 finite numbers, got '1 0 x'");
  expect_error(line, R"(<line/>)", 30, "attribute 'to' is missing");
  expect_error(line, R"(<line to="1 0 0" center="0 0 0"/>)", 30, "unknown attribute");
  expect_error(line, R"(<spline/>)" + line, 30, "<spline> of beam 'forearm': unknown element, expected line, arc");
  expect_error(arc, R"(<arc to="2 1 0" center="1 1.00001 0"/>)", 31, "center must be equally far from both ends");
  expect_error(arc, R"(<arc to="3 0 0" center="2 0 0"/>)", 31, "center must not lie on the line through both ends");
  expect_error(arc, R"(<arc to="1 0 0" center="2 0 0"/>)", 31, "the arc must have a length");
  expect_error(arc, R"(<arc to="2 1 0"/>)", 31, "attribute 'center' is missing");
  expect_error(arc, R"(<line to="0.5 0 0"/>)", 31, "the centreline must not turn back on itself");
  expect_error(R"(<centerline> <line to="0 0 1"/> </centerline>)", "", 53,
               "<beam> of link 'tip': <centerline> is missing");
  expect_error(R"(<line to="0 0 1"/>)", "", 54, "at least one <line> or <arc> is expected");
}

TEST(BeamErrors, Orientation) {
  const std::string good = R"(<orientation y="0 2 0"/>)";
  expect_error(good, R"(<orientation y="0 0 0"/>)", 33, "y must not be zero");
  expect_error(good, R"(<orientation y="3 0 0"/>)", 33, "y must not be parallel");
  expect_error(good, R"(<orientation/>)", 33, "attribute 'y' is missing");
}

TEST(BeamErrors, ShapesAndMaterial) {
  const std::string tube = R"(<tube outer_radius="0.02" inner_radius="0.01"/>)";
  expect_error(tube, R"(<circle radius="-0.01"/>)", 34,
               "scene.urdf:34: <circle> of beam 'forearm': radius must be > 0, got '-0.01'");
  expect_error(tube, R"(<circle radius="0.01 m"/>)", 34, "radius must be a finite number, got '0.01 m'");
  expect_error(tube, R"(<circle/>)", 34, "attribute 'radius' is missing");
  expect_error(tube, R"(<tube outer_radius="1" inner_radius="1"/>)", 34, "inner_radius must be < outer_radius");
  expect_error(tube, R"(<tube outer_radius="1" inner_radius="0"/>)", 34, "inner_radius must be > 0");
  expect_error(tube, R"(<rectangle width="1" height="0"/>)", 34, "height must be > 0");
  expect_error(tube, R"(<box_tube width="1" height="2" thickness="0.5"/>)", 34, "thickness must be less than half");
  expect_error(tube, tube + R"(<circle radius="1"/>)", 34, "the beam has a section already, <tube>");
  expect_error(tube, "", 28, "a section is missing");
  expect_error(R"(young="70e9")", R"(young="0")", 35, "young must be > 0, got '0'");
  expect_error(R"(poisson="0.33")", R"(poisson="0.5")", 35, "poisson must be in (-1, 0.5), got '0.5'");
  expect_error(R"(density="2700")", R"(density="inf")", 35, "density must be a finite number");
  expect_error(R"(<material young="70e9" poisson="0.33" density="2700"/>)", "", 28, "<material> is missing");
  expect_error(R"(mass_proportional="0.1")", R"(mass_proportional="-0.1")", 36, "mass_proportional must be >= 0");
}

TEST(BeamErrors, DirectSection) {
  expect_error(R"(ea="1")", R"(ea="0")", 55, "<section> of beam 'tip': ea must be > 0, got '0'");
  expect_error(R"(mass="7")", "", 55, "attribute 'mass' is missing");
  expect_error(R"(j2="9")", R"(j2="-9")", 55, "j2 must be >= 0");
  expect_error(R"(<section ea)", R"(<material young="1" poisson="0" density="1"/><section ea)", 55,
               "no place for a material");
}

TEST(BeamErrors, SectionMatrix) {
  const std::string section =
      R"(<section ea="1" ga2="2" ga3="3" gj="4" ei2="5" ei3="6" mass="7" j1="8" j2="9" j3="10"/>)";
  const auto matrix = [](const std::string& stiffness, const std::string& inertia) {
    return "<section_matrix stiffness=\"" + stiffness + "\" inertia=\"" + inertia + "\"/>";
  };
  const std::string unit = "1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1";
  EXPECT_TRUE(read(good_scene_with(section, matrix(unit, unit))).scene);
  // Mass 1 at d = (0, 0.1, 0.2): the upper right block is -m d^, the lower left one is m d^.
  const std::string offset =
      "1 0 0 0 0.2 -0.1  0 1 0 -0.2 0 0  0 0 1 0.1 0 0  0 -0.2 0.1 1 0 0  0.2 0 0 0 1 0  -0.1 0 0 0 0 1";
  EXPECT_TRUE(read(good_scene_with(section, matrix(unit, offset))).scene);

  const auto with = [](std::string text, std::size_t word, const std::string& value) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < word; ++i) begin = text.find(' ', begin) + 1;
    return text.replace(begin, text.find(' ', begin) - begin, value);
  };
  expect_error(section, matrix(unit + " 1", unit), 55, "stiffness must be 36 finite numbers");
  expect_error(section, matrix(with(unit, 1, "1e-8"), unit), 55, "stiffness must be symmetric");
  expect_error(section, matrix(with(unit, 7, "-1"), unit), 55, "stiffness must be positive definite");
  expect_error(section, matrix(with(with(unit, 1, "2"), 6, "2"), unit), 55, "stiffness must be positive definite");
  expect_error(section, matrix(unit, with(unit, 0, "2")), 55, "inertia must be [[m 1, -m d^], [m d^, J]]");
  expect_error(section, matrix(unit, with(unit, 1, "0.1")), 55, "inertia must be");
  expect_error(section, matrix(unit, with(unit, 4, "0.1")), 55, "inertia must be");
  expect_error(section, matrix(unit, with(unit, 21, "-1")), 55, "inertia must be");
}

TEST(BeamWarnings, UnitsThatAreProbablyOthers) {
  const auto said_of = [](const std::string& length, const std::string& radius, const std::string& young,
                          const std::string& density) {
    const ReadResult result = read("<robot name=\"r\"><link name=\"a\">\n<beam><centerline><line to=\"" + length +
                                   " 0 0\"/></centerline><circle radius=\"" + radius + "\"/><material young=\"" +
                                   young + "\" poisson=\"0.3\" density=\"" + density + "\"/></beam></link></robot>");
    EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
    return to_text(result.diagnostics);
  };
  const std::string beam = "scene.urdf:2: warning: <beam> of link 'a': ";
  EXPECT_EQ(said_of("1", "0.015", "70e9", "2700"), "");
  for (const char* young : {"70", "7e4"})  // GPa, MPa
    EXPECT_EQ(said_of("1", "0.015", young, "2700").find(beam + "young = " + young[0]), 0u) << young;
  EXPECT_EQ(said_of("1", "0.015", "5e4", "1100"), "") << "soft silicone";
  EXPECT_EQ(said_of("1", "0.015", "70e9", "2.7").find(beam + "density = 2.7 is in kg/m^3"), 0u);
  EXPECT_EQ(said_of("1", "0.015", "70e9", "1e-3"), "") << "as good as without mass";
  EXPECT_EQ(said_of("1", "15", "70e9", "2700").find(beam + "is 30 m thick and 1 m long"), 0u);
  EXPECT_EQ(said_of("1000", "0.015", "70e9", "2700").find(beam + "is 1000 m long and 0.03 m thick"), 0u);
  EXPECT_EQ(said_of("100", "0.003", "70e9", "2700"), "") << "a rope";
}

}  // namespace flexarm::scene
