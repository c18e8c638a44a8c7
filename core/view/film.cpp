#include "core/view/film.hpp"

#include <algorithm>
#include <array>
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

/// What ffmpeg is asked for, by the file's ending. A thorough search for motion makes films of drawings no
/// smaller, and threads of the encoder wait for frames. WebP moves on pages, where they show pictures.
const std::vector<std::string>* encoding_of(const std::string& path) {
  using Words = std::vector<std::string>;
  static const Words kH264 = {"-c:v",
                              "libx264",
                              "-preset",
                              "veryfast",
                              "-crf",
                              "18",
                              "-x264-params",
                              "partitions=i4x4:me=dia:subme=1:rc-lookahead=5",
                              "-threads",
                              "1",
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

/// Else its encoder takes pixels: it loses nothing of them.
bool takes_planes(const std::string& path) {
  return fs::path(path).extension() != ".webp";
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

hal::Status Film::start_encoder() {
  std::array<std::uint32_t, 2> size = {frame_.width(), frame_.height()};
  if (!takes_planes(config_.path)) std::memcpy(size.data(), pixels_.data(), sizeof size);
  std::vector<std::string> words = {"-hide_banner", "-loglevel", "error", "-nostats", "-y", "-f", "rawvideo"};
  const auto add = [&words](const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  add({"-pix_fmt", takes_planes(config_.path) ? "yuv420p" : "bgr0"});
  add({"-s", std::to_string(size[0]) + "x" + std::to_string(size[1])});
  add({"-r", hal::format_number(config_.frames_per_second), "-i", "pipe:0"});
  add(*encoding_of(config_.path));
  words.push_back("file:" + file_->part());
  auto encoder = hal::Program::start(hal::find_program("ffmpeg"), words);
  if (!encoder.ok()) return encoder.error();
  encoder_ = std::move(encoder).value();
  return {};
}

hal::Status Film::add(const Drawing& drawing) {
  constexpr int kSpare_px = 30;  // for a line of the legend that comes later
  if (config_.look.height_px == 0) config_.look.height_px = svg_height_px(drawing, config_.look) + kSpare_px;
  const std::string svg = to_svg(drawing, config_.look);
  const hal::Status added = digits_ > 0 ? add_picture(svg) : add_to_video(svg);
  if (added.ok()) ++frames_;
  return added;
}

hal::Status Film::add_picture(const std::string& svg) {
  const auto rendered = render(svg, PictureFormat::Png);
  return rendered.ok() ? hal::write_whole_file(picture_path(frames_), "frame", rendered.value()) : rendered.error();
}

hal::Status Film::add_to_video(const std::string& svg) {
  std::swap(pixels_, before_pixels_);
  if (const hal::Status rendered = render_pixels(svg, pixels_); !rendered.ok()) return rendered;
  if (!frame_.show(pixels_, before_pixels_)) return hal::Error{"a frame has another size than the first one"};
  if (encoder_ == nullptr) {
    if (const hal::Status started = start_encoder(); !started.ok()) return started;
  }
  constexpr std::size_t kSize_bytes = 8;
  const hal::Status fed =
      encoder_->feed(takes_planes(config_.path) ? frame_.planes() : std::string_view(pixels_).substr(kSize_bytes));
  if (fed.ok()) return fed;
  return hal::Error{"film '" + config_.path + "', frame " + std::to_string(frames_) + ": " + fed.error().message};
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
