#include "core/view/film.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "core/view/render.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

namespace fs = std::filesystem;

/// Around the number in names of pictures; no digits: a video.
struct Name {
  std::string before, after;
  int digits = 0;
};

/// What ffmpeg is asked for, by the file's ending. The usual players want H.264's pixels in fours, and so an even
/// number of them along both sides. WebP moves on pages, where they show pictures.
const std::vector<std::string>* encoding_of(const std::string& path) {
  using Words = std::vector<std::string>;
  static const Words kH264 = {"-vf",      "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
                              "-c:v",     "libx264",
                              "-preset",  "veryfast",
                              "-crf",     "18",
                              "-pix_fmt", "yuv420p",
                              "-f"};
  const auto in = [](Words words, const char* container) {
    words.emplace_back(container);
    return words;
  };
  static const std::map<std::string, Words> kEndings = {
      {".mp4", in(kH264, "mp4")},
      {".mkv", in(kH264, "matroska")},
      {".webp", {"-c:v", "libwebp_anim", "-lossless", "1", "-loop", "0", "-f", "webp"}}};
  const auto found = kEndings.find(fs::path(path).extension().string());
  return found == kEndings.end() ? nullptr : &found->second;
}

hal::Result<Name> name_of(const std::string& path) {
  const hal::Error forms{"the film '" + path +
                         "' must end in .mp4, .mkv or .webp, or be pictures: 'FOLDER/' or 'FOLDER/%06d.png'"};
  if (path.ends_with('/')) return Name{path, ".png", 6};
  const std::string ending = fs::path(path).extension().string();
  if (encoding_of(path) != nullptr) return Name{};
  const std::size_t begin = path.find('%');
  const std::size_t end = path.find('d', begin == std::string::npos ? 0 : begin);
  if (ending != ".png" || begin == std::string::npos || end == std::string::npos) return forms;
  const std::string number = path.substr(begin + 1, end - begin - 1);
  if (number.size() != 2 || number[0] != '0' || number[1] < '1' || number[1] > '9') return forms;
  if (path.find('%', end) != std::string::npos) return forms;
  return Name{path.substr(0, begin), path.substr(end + 1), number[1] - '0'};
}

}  // namespace

hal::Status Film::can_make(const std::string& path) {
  const auto name = name_of(path);
  if (!name.ok()) return name.error();
  if (const hal::Status renderer = can_render(PictureFormat::Png); !renderer.ok()) return renderer;
  if (name.value().digits == 0 && hal::find_program("ffmpeg").empty()) {
    return hal::Error{"the film '" + path +
                      "' is encoded by ffmpeg, which is not installed: sudo apt-get install ffmpeg; or make pictures "
                      "alone: 'FOLDER/'"};
  }
  return {};
}

hal::Result<std::unique_ptr<Film>> Film::open(const FilmConfig& config) {
  if (const hal::Status can = can_make(config.path); !can.ok()) return can.error();
  Name name = name_of(config.path).value();
  std::unique_ptr<Film> film(new Film());
  film->config_ = config;
  film->before_ = std::move(name.before);
  film->after_ = std::move(name.after);
  film->digits_ = name.digits;
  if (film->digits_ > 0) {
    const fs::path folder = fs::path(film->picture_path(0)).parent_path();
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) return hal::Error{"the folder '" + folder.string() + "' of the film: " + error.message()};
    return film;
  }
  auto file = hal::OutputFile::open(config.path, "film");
  if (!file.ok()) return file.error();
  if (file.value().part().empty()) return hal::Error{"the film '" + config.path + "' must be an ordinary file"};
  film->file_ = std::move(file).value();
  return film;
}

std::string Film::picture_path(std::int64_t frame) const {
  std::string number = std::to_string(frame);
  const auto digits = static_cast<std::size_t>(digits_);
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return before_ + number + after_;
}

hal::Status Film::start_encoder(const std::string& pixels) {
  std::uint32_t size[2];
  std::memcpy(size, pixels.data(), sizeof size);
  std::vector<std::string> words = {"-hide_banner",
                                    "-loglevel",
                                    "error",
                                    "-nostats",
                                    "-y",
                                    "-f",
                                    "rawvideo",
                                    "-pix_fmt",
                                    "bgr0",
                                    "-s",
                                    std::to_string(size[0]) + "x" + std::to_string(size[1]),
                                    "-r",
                                    hal::format_number(config_.frames_per_second),
                                    "-i",
                                    "pipe:0"};
  words.insert(words.end(), encoding_of(config_.path)->begin(), encoding_of(config_.path)->end());
  words.push_back("file:" + file_->part());
  auto encoder = hal::Program::start(hal::find_program("ffmpeg"), words);
  if (!encoder.ok()) return encoder.error();
  encoder_ = std::move(encoder).value();
  frame_bytes_ = pixels.size();
  return {};
}

hal::Status Film::add(const Drawing& drawing) {
  constexpr int kSpare_px = 30;  // for a line of the legend that comes later
  if (config_.look.height_px == 0) config_.look.height_px = svg_height_px(drawing, config_.look) + kSpare_px;
  const auto rendered = render(to_svg(drawing, config_.look), digits_ > 0 ? PictureFormat::Png : PictureFormat::Pixels);
  if (!rendered.ok()) return rendered.error();
  const std::string& frame = rendered.value();
  if (digits_ > 0) {
    if (const hal::Status written = hal::write_whole_file(picture_path(frames_), "frame", frame); !written.ok())
      return written;
  } else {
    if (encoder_ == nullptr) {
      if (const hal::Status started = start_encoder(frame); !started.ok()) return started;
    }
    if (frame.size() != frame_bytes_) return hal::Error{"a frame has another size than the first one"};
    constexpr std::size_t kSize_bytes = 8;
    if (const hal::Status fed = encoder_->feed(std::string_view(frame).substr(kSize_bytes)); !fed.ok())
      return hal::Error{"film '" + config_.path + "', frame " + std::to_string(frames_) + ": " + fed.error().message};
  }
  ++frames_;
  return {};
}

hal::Status Film::close() {
  if (digits_ > 0) return {};
  if (encoder_ == nullptr) return hal::Error{"film '" + config_.path + "' has no frame"};
  if (const hal::Status ended = encoder_->finish(); !ended.ok())
    return hal::Error{"film '" + config_.path + "': " + ended.error().message};
  return file_->commit();
}

std::string Film::remark() const {
  std::error_code error;
  if (digits_ == 0 || !fs::exists(picture_path(frames_), error)) return {};
  return "'" + picture_path(frames_) + "' is of an older film, and so are those behind it";
}

}  // namespace tandem::core
