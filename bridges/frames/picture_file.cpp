#include "bridges/frames/picture_file.hpp"

#include <png.h>

#include "bridges/frames/frame_parser.hpp"
#include "hal/input_file.hpp"

namespace tandem::bridges::frames {
namespace {

hal::Result<Frame> read_png(const std::string& path, const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    return hal::Error{"picture '" + path + "' cannot be read: " + image.message};
  if (image.width == 0 || image.height > kMostPixels / image.width) {
    png_image_free(&image);
    return hal::Error{"picture '" + path + "' is too large"};
  }
  image.format = PNG_FORMAT_GRAY;
  Frame frame;
  frame.width = image.width;
  frame.height = image.height;
  frame.grey.resize(frame.width * frame.height);
  const png_color black{};
  if (png_image_finish_read(&image, &black, frame.grey.data(), 0, nullptr) == 0)
    return hal::Error{"picture '" + path + "' is damaged: " + image.message};
  return frame;
}

}  // namespace

hal::Result<Frame> read_picture(const std::string& path) {
  const auto read = hal::read_whole_file(path, "picture");
  if (!read.ok()) return read.error();
  const std::string& bytes = read.value();
  if (bytes.starts_with("\x89PNG")) return read_png(path, bytes);
  FrameParser parser;
  parser.add(std::as_bytes(std::span(bytes)));
  Frame frame;
  if (!parser.next(frame)) return hal::Error{"picture '" + path + "' is neither PNG nor PGM with 8 bits"};
  return frame;
}

}  // namespace tandem::bridges::frames
