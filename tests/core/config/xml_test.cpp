#include "hal/xml/xml.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

struct Bad {
  std::string name, text;
  int line;
  std::string message;
};

void PrintTo(const Bad& bad, std::ostream* out) {
  *out << bad.name;
}

class NotXml : public testing::TestWithParam<Bad> {};

TEST_P(NotXml, IsSaidWithItsLine) {
  const Outcome out = read(GetParam().text);
  EXPECT_FALSE(out.scenario.has_value());
  ASSERT_EQ(out.problems.size(), 1U) << out.text();
  EXPECT_EQ(out.problems[0].line, GetParam().line) << out.text();
  EXPECT_THAT(out.problems[0].message, HasSubstr(GetParam().message));
}

std::string nested(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += "<a>";
  for (int i = 0; i < depth; ++i) text += "</a>";
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    All, NotXml,
    testing::Values(
        Bad{"empty", "", 1, "the file is empty"}, Bad{"blank", " \n\n ", 1, "the file is empty"},
        Bad{"words", "seven robots", 1, "is this an XML file?"},
        Bad{"comment_only", "<!-- nothing -->", 1, "there is no element in the file"},
        Bad{"mismatched", "<tandem>\n<arena>\n</tandem>", 2, "<arena> is never closed: line 3 closes <tandem>"},
        Bad{"mismatched_behind_what_looks_like_tags", "<tandem>\n<!-- <a> --><b x=\"</c>\"/><f\n y='>'>\n</tandem>", 2,
            "<f> is never closed: line 4 closes <tandem>"},
        Bad{"never_closed", "<tandem>\n<arena/>\n", 1, "<tandem> is never closed: the file ends"},
        Bad{"attribute_without_quotes", "<tandem>\n<arena size=4/></tandem>", 2, "name=\"value\""},
        Bad{"open_comment", "<tandem>\n<!-- </tandem>", 2, "never closed with -->"},
        Bad{"deep", nested(5000), 1, "nested too deeply"},
        Bad{"zero_byte", std::string("<tandem>\n\0</tandem>", 19), 2, "zero byte"},
        Bad{"other_root", "<html/>", 1, "the root element is <html>"}),
    [](const auto& bad) { return bad.param.name; });

TEST(Xml, ASecondRootIsAnError) {
  Parts parts;
  const Outcome out = read(parts.text() + "<tandem/>");
  ASSERT_EQ(out.problems.size(), 1U) << out.text();
  EXPECT_EQ(out.problems[0].line, 10);
  EXPECT_FALSE(out.scenario.has_value());
}

TEST(Xml, TakesByteOrderMarksWindowsLinesAndEntities) {
  Parts parts;
  parts.things = R"(<e-puck id="a&amp;b"><body position="0,0,0"/><controller config="w"/></e-puck>)";
  std::string text = parts.text();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
  EXPECT_EQ(read("\xEF\xBB\xBF" + text).good().robots[0].id, "a&b");
}

TEST(Xml, WritesWhatItRead) {
  Problems problems;
  const auto element = hal::read_xml_text(R"(<a x="1 &lt; 2"><b y="&quot;"/><c><d/></c></a>)", "t", problems);
  ASSERT_TRUE(element.has_value());
  const auto again = hal::read_xml_text(hal::to_xml(*element), "t", problems);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(*again->attribute("x"), "1 < 2");
  EXPECT_EQ(*again->child("b")->attribute("y"), "\"");
  EXPECT_NE(again->child("c")->child("d"), nullptr);
  EXPECT_TRUE(problems.empty());
}

class XmlFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("xml_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Outcome read_file(const std::string& name) {
    Outcome out;
    out.scenario = read_experiment(folder_ / name, {}, known_names(), out.problems);
    return out;
  }
  void expect_refused(const std::string& name, const std::string& message) {
    const Outcome out = read_file(name);
    EXPECT_FALSE(out.scenario.has_value());
    ASSERT_EQ(out.problems.size(), 1U) << out.text();
    EXPECT_EQ(out.problems[0].file, folder_ / name);
    EXPECT_THAT(out.problems[0].message, HasSubstr(message));
  }

  std::filesystem::path folder_;
};

TEST_F(XmlFile, IsReadWhole) {
  std::ofstream(folder_ / "good.xml") << Parts{}.text();
  EXPECT_EQ(read_file("good.xml").good().name, "good");
}
TEST_F(XmlFile, ThatIsMissingIsAnError) {
  expect_refused("none.xml", "there is no such file");
}
TEST_F(XmlFile, ThatIsAFolderIsAnError) {
  expect_refused(".", "this is a folder");
}
TEST_F(XmlFile, ThatIsEmptyIsAnError) {
  std::ofstream(folder_ / "empty.xml").flush();
  expect_refused("empty.xml", "the file is empty");
}
TEST_F(XmlFile, ThatIsAPipeIsAnError) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  expect_refused("pipe", "this is a pipe");
}
TEST_F(XmlFile, ThatIsALoopOfLinksIsAnError) {
  std::filesystem::create_symlink("loop.xml", folder_ / "loop.xml");
  expect_refused("loop.xml", "symbolic links");
}
TEST_F(XmlFile, ThatIsHugeIsAnError) {
  std::ofstream(folder_ / "huge.xml") << "<tandem>";
  std::filesystem::resize_file(folder_ / "huge.xml", (64U << 20U) + 1U);  // sparse
  expect_refused("huge.xml", "larger than 64 MiB");
}

}  // namespace
}  // namespace tandem::core
