#include "bridges/calibration/board.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tandem::bridges::calibration {
namespace {

using testing::HasSubstr;

TEST(Board, HasItsTagsWhereThePageShowsThem) {
  const Board board;
  ASSERT_TRUE(check_board(board).ok());
  EXPECT_NEAR(board.width_m(), 0.23, 1e-12);
  const auto first = board.corners_m(0), last = board.corners_m(23);
  ASSERT_TRUE(first && last);
  EXPECT_NEAR((*first)[3].x(), -0.115, 1e-12) << "upper left";
  EXPECT_NEAR((*first)[3].y(), 0.075, 1e-12);
  EXPECT_NEAR((*last)[1].x(), 0.115, 1e-12) << "lower right";
  EXPECT_NEAR((*last)[1].y(), -0.075, 1e-12);
  EXPECT_FALSE(board.corners_m(24).has_value());
  const auto svg = board_svg(board);
  ASSERT_TRUE(svg.ok());
  EXPECT_THAT(svg.value(), HasSubstr("width=\"297mm\""));
  // The first line of the first tag is black from corner to corner: 30 mm.
  EXPECT_THAT(svg.value(), HasSubstr("<rect x=\"33.5\" y=\"20\" width=\"30\""));
  EXPECT_THAT(svg.value(), HasSubstr("width=\"100\" height=\"0.4\"")) << "the line to check";
}

TEST(Board, RefusesWhatCannotBePrintedOrFound) {
  const auto why = [](const Board& board) { return check_board(board).error().message; };
  EXPECT_THAT(why({.family = "tag99"}), HasSubstr("tag36h11"));
  EXPECT_THAT(why({.columns = 9}), HasSubstr("too large for A4"));
  EXPECT_THAT(why({.gap_m = 0.005}), HasSubstr("7.5 mm of white"));
  EXPECT_THAT(why({.first = 580}), HasSubstr("more than the 587"));
  EXPECT_THAT(why({.rows = 1}), HasSubstr("2 to 100"));
}

TEST(Board, IsTheSameFromItsFile) {
  const std::string path =
      std::filesystem::path(testing::TempDir()) / ("tandem_board_" + std::to_string(::getpid()) + ".json");
  ASSERT_TRUE(write_board(path, {.columns = 5, .size_m = 0.025, .first = 40}).ok());
  const auto board = read_board(path);
  ASSERT_TRUE(board.ok()) << board.error().message;
  EXPECT_EQ(board.value().columns, 5U);
  EXPECT_EQ(board.value().first, 40U);
  for (const char* text :
       {"", "{}", R"({"family":"tag36h11","columns":1,"rows":4,"size_m":1,"gap_m":1,"first":0})",
        R"({"family":"tag36h11","columns":9999999,"rows":9999999,"size_m":1,"gap_m":1,"first":0})"}) {
    std::ofstream(path) << text;
    EXPECT_FALSE(read_board(path).ok()) << text;
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace tandem::bridges::calibration
