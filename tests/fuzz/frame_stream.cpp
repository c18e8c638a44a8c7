// The parser of streams of frames, fed with anything in pieces of any size: what it gives is whole.
#include <cstdint>
#include <cstdlib>

#include "bridges/frames/frame_parser.hpp"

namespace {

using namespace tandem::bridges::frames;

void parse(const std::uint8_t* data, std::size_t size, std::size_t piece) {
  FrameParser parser;
  Frame frame;
  std::size_t bytes = 0;
  for (std::size_t at = 0; at < size; at += piece) {
    const std::size_t count = size - at < piece ? size - at : piece;
    parser.add(std::as_bytes(std::span(data + at, count)));
    while (parser.next(frame)) {
      if (frame.width == 0 || frame.height == 0 || frame.grey.size() != frame.width * frame.height) std::abort();
      bytes += frame.grey.size();
    }
  }
  if (bytes > size) std::abort();  // no byte is used twice
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  parse(data, size, 1 + data[0] % 16);
  // Behind a good beginning, so that what follows is looked at, too.
  for (const std::string_view beginning :
       {std::string_view("TDF1"), std::string_view("P5 "), std::string_view("YUV4MPEG2 W2 H2 C420\nFRAME\n"),
        std::string_view("TDF1\2\0\0\0\1\0\0\0\0\0\0\0", 16)}) {
    std::vector<std::uint8_t> bytes(beginning.begin(), beginning.end());
    bytes.insert(bytes.end(), data, data + size);
    parse(bytes.data(), bytes.size(), bytes.size());
  }
  return 0;
}
