#include "bridges/frames/frame_parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <sstream>
#include <string_view>

namespace tandem::bridges::frames {
namespace {

constexpr std::size_t kOwnHeader = 24;
constexpr std::size_t kLongestLine = 512;  // of a header
constexpr std::size_t kKeptUsed = std::size_t{1} << 20U;

std::uint64_t little_endian(const std::uint8_t* bytes, std::size_t count) noexcept {
  std::uint64_t n = 0;
  for (std::size_t i = count; i-- > 0;) n = n << 8U | bytes[i];
  return n;
}

bool is_number(std::string_view text, std::size_t& value) noexcept {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size();
}

}  // namespace

void FrameParser::add(std::span<const std::byte> bytes) {
  if (at_ >= kKeptUsed || at_ == bytes_.size()) {
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = 0;
  }
  const auto* const first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  bytes_.insert(bytes_.end(), first, first + bytes.size());
}

void FrameParser::reset() {
  bytes_.clear();
  at_ = 0;
  in_y4m_ = lost_ = false;
}

bool FrameParser::next(Frame& frame) {
  for (;;) {
    if (lost_) look_on();
    if (lost_) return false;
    switch (read(frame)) {
      case Found::Frame:
        return true;
      case Found::Nothing:
        return false;
      case Found::Header:
        break;
      case Found::Malformed:
        lost_ = true;
        break;
    }
  }
}

bool FrameParser::begins_with(const char* text) const noexcept {
  const std::size_t length = std::strlen(text);
  return left() >= length && std::memcmp(bytes_.data() + at_, text, length) == 0;
}

FrameParser::Found FrameParser::read(Frame& frame) {
  constexpr std::size_t kToKnow = 10;
  if (in_y4m_ && begins_with("FRAME")) return read_y4m_frame(frame);
  if (begins_with("TDF1")) return read_own(frame);
  if (begins_with("P5")) return read_pgm(frame);
  if (begins_with("YUV4MPEG2 ")) return read_y4m_header();
  if (left() < kToKnow) return Found::Nothing;
  return malformed("it is neither tandem-frames nor Y4M nor PGM");
}

FrameParser::Found FrameParser::malformed(const std::string& why) {
  ++malformed_;
  trouble_ = why;
  ++at_;
  return Found::Malformed;
}

/// Goes on to the next bytes that may begin a frame.
void FrameParser::look_on() {
  static constexpr std::array<std::string_view, 4> kBeginnings = {"TDF1", "P5", "YUV4MPEG2 ", "FRAME"};
  const std::string_view all(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  std::size_t found = std::string_view::npos;
  for (const std::string_view beginning : kBeginnings) {
    if (beginning == "FRAME" && !in_y4m_) continue;
    if (beginning == "P5" && in_y4m_) continue;
    found = std::min(found, all.find(beginning, at_));
  }
  lost_ = found == std::string_view::npos;
  constexpr std::size_t kLongest = 10;
  at_ = lost_ ? std::max(at_, bytes_.size() - std::min(bytes_.size(), kLongest - 1)) : found;
}

bool FrameParser::fits(std::size_t width, std::size_t height) const noexcept {
  return width > 0 && height > 0 && width <= kMostPixels && height <= kMostPixels / width;
}

void FrameParser::take(Frame& frame, std::size_t width, std::size_t height, std::size_t from) {
  frame.width = width;
  frame.height = height;
  const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + from);
  frame.grey.assign(first, first + static_cast<std::ptrdiff_t>(width * height));
  frame.stamp_ns.reset();
}

FrameParser::Found FrameParser::read_own(Frame& frame) {
  if (left() < kOwnHeader) return Found::Nothing;
  const std::uint8_t* const header = bytes_.data() + at_;
  const auto width = static_cast<std::size_t>(little_endian(header + 4, 4));
  const auto height = static_cast<std::size_t>(little_endian(header + 8, 4));
  if (little_endian(header + 12, 4) != 0 || !fits(width, height))
    return malformed("a header of a frame makes no sense");
  if (left() < kOwnHeader + width * height) return Found::Nothing;
  const auto stamp_ns = static_cast<std::int64_t>(little_endian(header + 16, 8));
  take(frame, width, height, kOwnHeader);
  if (stamp_ns != 0) frame.stamp_ns = stamp_ns;
  at_ += kOwnHeader + width * height;
  return Found::Frame;
}

/// "P5", width, height and 255 with white space and comments between, one byte of white space, pixels.
FrameParser::Found FrameParser::read_pgm(Frame& frame) {
  std::array<std::size_t, 3> numbers{};
  std::size_t i = at_ + 2;
  const std::size_t end = std::min(bytes_.size(), at_ + kLongestLine);
  const auto incomplete = [&] {
    return end == bytes_.size() && left() < kLongestLine ? Found::Nothing : malformed("the header of a PGM has no end");
  };
  for (std::size_t& number : numbers) {
    for (;; ++i) {
      if (i >= end) return incomplete();
      if (bytes_[i] == '#') {
        while (i < end && bytes_[i] != '\n') ++i;
        if (i >= end) return incomplete();
      } else if (std::strchr(" \t\r\n", bytes_[i]) == nullptr || bytes_[i] == 0) {
        break;
      }
    }
    std::size_t digits = 0;
    for (; i < end && bytes_[i] >= '0' && bytes_[i] <= '9'; ++i, ++digits) {
      if (digits > 8) return malformed("a number in the header of a PGM is too large");
      number = 10 * number + static_cast<std::size_t>(bytes_[i] - '0');
    }
    if (i >= end) return incomplete();
    if (digits == 0) return malformed("the header of a PGM makes no sense");
  }
  if (!fits(numbers[0], numbers[1]) || numbers[2] != 255) return malformed("a PGM must have 8 bits a pixel");
  const std::size_t header = i + 1 - at_;
  if (left() < header + numbers[0] * numbers[1]) return Found::Nothing;
  take(frame, numbers[0], numbers[1], header);
  at_ += header + numbers[0] * numbers[1];
  return Found::Frame;
}

FrameParser::Found FrameParser::read_y4m_header() {
  const std::string_view all(reinterpret_cast<const char*>(bytes_.data()) + at_, left());
  const std::size_t end = all.find('\n');
  if (end == std::string_view::npos)
    return left() < kLongestLine ? Found::Nothing : malformed("the header of Y4M has no end");
  Y4m y4m;
  std::string colours = "420";
  std::istringstream words{std::string(all.substr(0, end))};
  for (std::string word; words >> word;) {
    const std::string_view rest = std::string_view(word).substr(1);
    if (word[0] == 'W' && !is_number(rest, y4m.width)) y4m.width = 0;
    if (word[0] == 'H' && !is_number(rest, y4m.height)) y4m.height = 0;
    if (word[0] == 'C') colours = rest;
  }
  if (!fits(y4m.width, y4m.height)) return malformed("the header of Y4M tells no size");
  const std::size_t half_width = (y4m.width + 1) / 2, half_height = (y4m.height + 1) / 2;
  if (colours.starts_with("420") && !colours.starts_with("420p1")) {
    y4m.chroma_bytes = 2 * half_width * half_height;
  } else if (colours == "422") {
    y4m.chroma_bytes = 2 * half_width * y4m.height;
  } else if (colours == "444") {
    y4m.chroma_bytes = 2 * y4m.width * y4m.height;
  } else if (colours != "mono") {
    return malformed("Y4M with the colours C" + colours.substr(0, 16) + " is not read; make it gray (-pix_fmt gray)");
  }
  y4m_ = y4m;
  in_y4m_ = true;
  at_ += end + 1;
  return Found::Header;
}

FrameParser::Found FrameParser::read_y4m_frame(Frame& frame) {
  const std::string_view all(reinterpret_cast<const char*>(bytes_.data()) + at_, std::min(left(), kLongestLine));
  const std::size_t end = all.find('\n');
  if (end == std::string_view::npos)
    return left() < kLongestLine ? Found::Nothing : malformed("the header of a frame of Y4M has no end");
  const std::size_t pixels = y4m_.width * y4m_.height;
  if (left() < end + 1 + pixels + y4m_.chroma_bytes) return Found::Nothing;
  take(frame, y4m_.width, y4m_.height, end + 1);
  at_ += end + 1 + pixels + y4m_.chroma_bytes;
  return Found::Frame;
}

}  // namespace tandem::bridges::frames
