/// Tests that any bytes lead to diagnostics, and never to a crash or a hang.

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "scene/scene_text.h"
#include "support/source_path.h"

namespace flexarm::scene {
namespace {

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// Checks that there is a scene exactly if there is no error, and that each message fits into one line.
void expect_consistent(const ReadResult& result) {
  EXPECT_EQ(result.scene.has_value(), !has_errors(result.diagnostics));
  for (const Diagnostic& finding : result.diagnostics)
    EXPECT_EQ(finding.text().find('\n'), std::string::npos) << finding.text();
}

}  // namespace

TEST(HostileInput, NotXml) {
  expect_one_error("", 1, "must be well-formed XML, but the file is empty");
  expect_one_error("<!-- nothing -->", 1, "the outermost element must be <robot>");
  expect_one_error("<robot name=\"r\">\n<link name=\"a\">\n</robot>", 2,
                   "must be well-formed XML, but <link> has no end tag </link>");
  expect_one_error("<robot name=\"r\">\n<link name='a' name='b'/></robot>", 2, "must be well-formed XML");
  expect_one_error("<sdf/>", 1, "the outermost element must be <robot>, got 'sdf'");
  expect_one_error("<robot name=\"r\">\n\xff</robot>", 2,
                   "must be text in UTF-8 without control characters, got byte 255");
  expect_one_error(std::string("<robot name=\"r\"/>\0", 18), 1, "got byte 0");
  expect_one_error("<robot name=\"r\"/>", 1, "at least one <link> is expected");
  expect_one_error("<robot><link name=\"a\"/></robot>", 1, "attribute 'name' is missing");
}

TEST(HostileInput, Entities) {
  expect_one_error("<!DOCTYPE robot [<!ENTITY a \"b\">]>\n<robot name=\"r\"/>", 1,
                   "document type and entity declarations are not allowed, got '<!DOCTYPE robot [<!E'");
  expect_one_error("<robot name=\"r\">\n<!ENTITY a \"b\"></robot>", 2, "document type and entity declarations");
  EXPECT_TRUE(read("<robot name=\"r\"><!-- <!DOCTYPE --><link name=\"a\"><![CDATA[<!ENTITY]]></link></robot>").scene);
}

TEST(HostileInput, Size) {
  const std::string head = "<robot name=\"r\"><link name=\"a\"/>";
  expect_one_error(head + std::string(20u << 20, ' ') + "</robot>", 0, "may have 16777216 bytes");
  expect_one_error(head + repeated("<a>", 40) + repeated("</a>", 40) + "</robot>", 1, "nested 32 deep");
  expect_one_error(head + repeated("<a>", 100000) + "</robot>", 1, "nested 32 deep");
  EXPECT_TRUE(has_errors(read(repeated("<robot>", 1000000)).diagnostics));

  std::string links = head;
  for (int i = 0; i < 20000; ++i) links += "<link name=\"l" + std::to_string(i) + "\"/>";
  EXPECT_NE(to_text(read(links + "</robot>").diagnostics).find("a scene has at most 10000 links"), std::string::npos);

  const std::string loads = head + "<simulation>" + repeated("<load link=\"a\" force=\"1 0 0\"/>\n", 20000);
  expect_one_error(loads + "</simulation></robot>", 1, "at most 10000 entries are allowed");
}

TEST(HostileInput, Attributes) {
  std::string text = "<robot name=\"r\">\n<link name=\"a\"";
  for (int i = 0; i < 500000; ++i) text += " a" + std::to_string(i) + "='>'";
  expect_one_error(text + "/></robot>", 2, "an element may have 1000 attributes, got '<link name=\"a\" a0='>'");
  // Text that only looks like attributes.
  const std::string equals(5000, '=');
  EXPECT_TRUE(read("<robot name=\"r\"><!--<a " + equals + "--><link name=\"a\"><visual name=\"" + equals + "\"/><b>" +
                   "<![CDATA[<a " + equals + "]]>" + equals + "</b></link></robot>")
                  .scene);
}

TEST(HostileInput, LongChainsTakeSeconds) {
  std::string chain = "<robot name=\"r\"><link name=\"l0\"/>";
  for (int i = 1; i < 9000; ++i) {
    const std::string n = std::to_string(i), above = std::to_string(i - 1);
    chain += "<link name=\"l" + n + "\"/><joint name=\"j" + n + "\" type=\"continuous\"><parent link=\"l" + above +
             "\"/><child link=\"l" + n + "\"/>" + (i > 1 ? "<mimic joint=\"j" + above + "\"/>" : "") + "</joint>\n";
  }
  const ReadResult result = read(chain + "</robot>");
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
}

TEST(HostileInput, ManyErrorsAreListedInPart) {
  const ReadResult result = read("<robot name=\"r\"><link name=\"a\"/><simulation>\n" + repeated("<motion/>\n", 9000) +
                                 "</simulation></robot>");
  EXPECT_FALSE(result.scene);
  EXPECT_EQ(result.diagnostics.size(), 1001u);
  EXPECT_NE(result.diagnostics.back().text().find("further findings"), std::string::npos);
}

TEST(HostileInput, LongValuesAreShortened) {
  const ReadResult result = read(good_scene_with(R"(lower="-1")", "lower=\"" + std::string(1 << 20, 'x') + "\""));
  ASSERT_EQ(result.diagnostics.size(), 1u);
  EXPECT_LT(result.diagnostics[0].text().size(), 300u);
}

TEST(HostileInput, FilesThatCannotBeRead) {
  EXPECT_EQ(read_scene_file("/no/such/file.urdf").diagnostics.at(0).text(),
            "/no/such/file.urdf: cannot be read: No such file or directory");
  EXPECT_FALSE(read_scene_file(testing::TempDir()).scene);
  EXPECT_FALSE(read_scene_file("/dev/null").scene);
  EXPECT_FALSE(read_scene_file("/dev/zero").scene);
}

TEST(HostileInput, AllErrorsAreReportedAtOnce) {
  std::string text = good_scene_with(R"(<mass value="2"/>)", R"(<mass value="-2"/>)");
  const auto also = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  also(R"(<box size="1 1 1"/>)", "<bocks/>");
  also(R"(lower="-1")", R"(lower="x")");
  also(R"(<tube outer_radius="0.02")", R"(<tube outer_radius="-0.02")");
  also(R"(kind="universal")", R"(kind="x")");
  also(R"(<probe name="end" link="tip")", R"(<probe name="end" link="toe")");
  const ReadResult result = read(text);
  std::vector<int> lines;
  for (const Diagnostic& finding : result.diagnostics) lines.push_back(finding.line);
  EXPECT_EQ(lines, (std::vector<int>{10, 16, 19, 34, 44, 67})) << to_text(result.diagnostics);
}

TEST(HostileInput, HandlerOfTheLogIsRestored) {
  // The symbol is looked up by its name, because tests are not linked to console_bridge, which the library uses
  // internally.
  using Function = const void* (*)();
  const auto handler = reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, "_ZN14console_bridge16getOutputHandlerEv"));
  ASSERT_NE(handler, nullptr);
  const void* before = handler();
  EXPECT_FALSE(read(good_scene_with(R"(<box size="1 1 1"/>)", "<bocks/>")).diagnostics.empty());
  EXPECT_EQ(handler(), before);
}

namespace {

const char* const kFragments[] = {
    "<",  ">",   "\"", "/>", "<!--",   "-->",     "<![CDATA[",          "&", "&#0;", "&#xffff;", "\xef\xbf\xbe", "0",
    "-1", "nan", ":",  "?",  "<beam>", "</link>", "<link name=\"a\"/>", " ", "\n",   "=",        "\xc3\xa9",     "("};
const char* const kValues[] = {"",      "0",       "-1",       "-0",    "1e308", "1e-320", "99999999999", "0 0 0",
                               "1 0 0", "1e8 0 0", "1 1 1e9",  "t/0",   "0:1",   "em",     "auto",        "tip",
                               "arm",   "world",   "follower", "elbow", "ball",  "wheel",  "floating",    "fixed"};

/// Random numbers that are the same on every machine.
class Random {
 public:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_()) % n; }
  template <class List>
  const auto& choice(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::mt19937 engine_{1};
};

void mutate(std::string& text, Random& random) {
  const std::size_t at = random.below(text.size()), length = std::min(random.below(40), text.size() - at);
  switch (random.below(6)) {
    case 0:
      text[at] = static_cast<char>(random.below(256));
      break;
    case 1:
      text.erase(at, length);
      break;
    case 2:
      text.insert(at, random.choice(kFragments));
      break;
    case 3:
      text.insert(random.below(text.size()), text.substr(at, length));
      break;
    default: {  // another value for an attribute; the text stays well-formed
      const std::size_t begin = text.find("=\"", at);
      const std::size_t end = begin == std::string::npos ? begin : text.find('"', begin + 2);
      if (end != std::string::npos) text.replace(begin + 2, end - begin - 2, random.choice(kValues));
    }
  }
}

std::vector<std::string> good_scenes() {
  std::vector<std::string> scenes = {kGoodScene};
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("config/examples"))) {
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    scenes.push_back(text.str());
  }
  std::sort(scenes.begin(), scenes.end());  // the order in a directory differs between machines
  return scenes;
}

}  // namespace

TEST(HostileInput, MutatedScenes) {
  const std::vector<std::string> scenes = good_scenes();
  Random random;
  for (int i = 0; i < 4000; ++i) {
    std::string text = random.choice(scenes);
    for (std::size_t changes = 1 + random.below(4); changes > 0 && !text.empty(); --changes) mutate(text, random);
    expect_consistent(read(text));
    if (HasFailure()) FAIL() << text;
  }
}

}  // namespace flexarm::scene
