#include "bridges/frames/frame_parser.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::frames {
namespace {

std::string own(std::uint32_t width, std::uint32_t height, std::int64_t stamp_ns, const std::string& pixels) {
  std::string bytes = "TDF1";
  const auto put = [&](std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
  };
  put(width, 4);
  put(height, 4);
  put(0, 4);
  put(static_cast<std::uint64_t>(stamp_ns), 8);
  return bytes + pixels;
}

/// All frames of a stream that comes in pieces of that size.
std::vector<Frame> frames_of(FrameParser& parser, const std::string& stream, std::size_t piece) {
  std::vector<Frame> frames;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    parser.add(std::as_bytes(std::span(stream)).subspan(at, std::min(piece, stream.size() - at)));
    Frame frame;
    while (parser.next(frame)) frames.push_back(frame);
  }
  return frames;
}

std::string text(const Frame& frame) {
  return {frame.grey.begin(), frame.grey.end()};
}

TEST(FrameParser, ReadsAllThreeFormsInPiecesOfAnySize) {
  const std::string y4m = "YUV4MPEG2 W3 H2 F30:1 C420jpeg\nFRAME\nabcdefuuvvFRAME Ip\nghijkluuvv";
  const std::string all = own(3, 2, 5, "ABCDEF") + "P5\n# a comment\n2 2\n255\n0123" + own(1, 1, 0, "z") + y4m;
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, all.size()}) {
    FrameParser parser;
    const auto frames = frames_of(parser, all, piece);
    ASSERT_EQ(frames.size(), 5U) << piece << " " << parser.trouble();
    EXPECT_EQ(text(frames[0]), "ABCDEF");
    EXPECT_EQ(frames[0].width, 3U);
    EXPECT_EQ(frames[0].stamp_ns, 5);
    EXPECT_EQ(text(frames[1]), "0123");
    EXPECT_FALSE(frames[1].stamp_ns.has_value());
    EXPECT_FALSE(frames[2].stamp_ns.has_value());
    EXPECT_EQ(text(frames[3]), "abcdef");
    EXPECT_EQ(text(frames[4]), "ghijkl");
    EXPECT_EQ(parser.malformed(), 0U);
  }
}

TEST(FrameParser, GoesOnWithTheNextFrameAfterBytesThatAreNone) {
  const std::string cut = own(3, 2, 5, "ABC");  // its rest is taken from what follows
  FrameParser parser;
  const auto frames =
      frames_of(parser, "rubbish of some length" + own(1, 1, 1, "a") + cut + own(1, 1, 2, "b") + own(1, 1, 3, "c"), 5);
  ASSERT_GE(frames.size(), 2U);
  EXPECT_EQ(text(frames.front()), "a");
  EXPECT_EQ(text(frames.back()), "c");
  EXPECT_GE(parser.malformed(), 2U);
}

TEST(FrameParser, RefusesSizesAndColoursThatItCannotRead) {
  for (const std::string& stream :
       {own(0, 5, 1, ""), own(0xFFFFFFFF, 0xFFFFFFFF, 1, ""), std::string("P5 2 2 65535 abcdefgh"),
        std::string("YUV4MPEG2 W2 H2 C420p10\nFRAME\nabcdefghijkl"),
        std::string("YUV4MPEG2 Cmono\nFRAME\nabcdefghijk")}) {
    FrameParser parser;
    EXPECT_TRUE(frames_of(parser, stream, 3).empty());
    EXPECT_GE(parser.malformed(), 1U) << stream;
    EXPECT_FALSE(parser.trouble().empty());
  }
}

}  // namespace
}  // namespace tandem::bridges::frames
