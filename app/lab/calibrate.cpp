// `tandem calibrate`: boards, lenses, places of cameras.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <numbers>
#include <optional>

#include "app/command/command.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/process/progress.hpp"
#include "app/process/signals.hpp"
#include "bridges/calibration/lens_fit.hpp"
#include "bridges/calibration/place_fit.hpp"
#include "bridges/camera/camera_file.hpp"
#include "bridges/frames/frame_source.hpp"
#include "core/view/picture.hpp"
#include "core/view/render.hpp"
#include "hal/median.hpp"
#include "hal/output_file.hpp"
#include "hal/unit.hpp"

namespace tandem::app {
namespace {

struct CalibrateOptions {
  std::string out;            ///< what is made
  std::string board, frames;  ///< files of a board; where frames come from
  std::string camera;         ///< of `arena`: the file with the lens
  std::string family = "tag36h11";
  std::int64_t columns = 6, rows = 4, first = 0;
  std::string size = "30 mm", gap = "10 mm";
  std::int64_t every = 1, most = 40;
  bool wide = false;
  std::vector<std::string> tags;  ///< of `arena`: ID=X,Y[,Z[,DEGREES]]
  std::string at;                 ///< of `arena`: where the board lies: X,Y,DEGREES[,Z]
};

constexpr std::string_view kFrames = "camera:/dev/video0, film:FILE, folder:FOLDER of .png or .pgm, or pipe:FILE";

struct BoardOptions : CalibrateOptions {
  void describe(hal::CommandLine& line) {
    line.option("-o,--out", out, "The page: .pdf, .svg or .png").required().file();
    line.option("--columns", columns, "Tags in a line").show_default().range(2, 100);
    line.option("--rows", rows, "Lines").show_default().range(2, 100);
    line.option("--size", size, "Side of a tag's black square").show_default();
    line.option("--gap", gap, "White between two tags").show_default();
    line.option("--family", family, "Of tags").show_default();
    line.option("--first", first, "Number of the first tag").show_default().range(0, 100000);
  }
};

struct CameraOptions : CalibrateOptions {
  void describe(hal::CommandLine& line) {
    line.footer(
        "Show the board in 15 to 30 ways: tilted by 20 to 45 degrees to all sides, near and far, in all corners of the "
        "picture, held still and in focus. Focus and zoom must stay as they are from then on.");
    line.option("--board", board, "The file that `tandem calibrate board` wrote beside the page").required().file();
    line.option("--frames", frames, kFrames).required();
    line.option("-o,--out", out, "The camera's file").required().file();
    line.option("--every", every, "Only every so manyth frame: of films").range(1, 100000);
    line.option("--most", most, "Views that are enough").show_default().range(6, 200);
    line.flag("--wide", wide, "A third coefficient of distortion, for lenses of more than 90 degrees");
  }
};

struct ArenaOptions : CalibrateOptions {
  void describe(hal::CommandLine& line) {
    line.option("--camera", camera, "The camera's file, which gets its place").required().file();
    line.option("--frames", frames, kFrames).required();
    line.option("--tag", tags,
                "A tag that lies at X,Y (of its centre, in metres), at a height Z, its upper edge pointing to DEGREES: "
                "ID=X,Y[,Z[,DEGREES]]; repeatable, four at least")
        .repeatable();
    line.option("--size", size, "Side of these tags' black square, for those with DEGREES").show_default();
    line.option("--family", family, "Of tags").show_default();
    line.option("--board", board, "The board's file, where it is the board that lies there").file();
    line.option("--at", at, "Where its centre lies, where its upper edge points to, its thickness: X,Y,DEGREES[,Z]")
        .needs("--board");
    line.option("-o,--out", out, "Another file to write").file();
  }
};

namespace calibration = bridges::calibration;
namespace camera = bridges::camera;
namespace frames = bridges::frames;
using bridges::apriltag::Detection;
using bridges::apriltag::Detector;

constexpr int kWait_ms = 100;
constexpr std::size_t kFramesOfArena = 30;

int fail(const std::string& message, int code = kBadInput) {
  fmt::print(stderr, "error: {}\n", message);
  return code;
}

/// Tags of each frame, until the source is over, somebody ends it, or `use(number, frame, tags)` has enough.
hal::Status look_at_frames(const std::string& what, const std::string& family, std::int64_t every,
                           const std::function<bool(std::int64_t, const frames::Frame&, std::vector<Detection>)>& use) {
  std::signal(SIGPIPE, SIG_IGN);
  const std::atomic<bool>& stop = catch_signals();
  auto source = frames::open_frames(what, {.live = false});
  if (!source.ok()) return source.error();
  auto detector = Detector::make({family, 1.0, 2});
  if (!detector.ok()) return detector.error();
  frames::Frame frame;
  std::size_t width = 0, height = 0;
  for (std::int64_t number = 0; !stop;) {
    const auto got = source.value()->next(frame, kWait_ms);
    if (got == frames::FrameSource::Got::Over) break;
    if (got == frames::FrameSource::Got::Nothing) continue;
    if (number++ % every != 0) continue;
    if (width == 0) {
      width = frame.width;
      height = frame.height;
    }
    if (frame.width != width || frame.height != height)
      return hal::Error{
          fmt::format("frame {} is {}x{}, and the first was {}x{}", number, frame.width, frame.height, width, height)};
    if (!use(number, frame, detector.value()->detect(frame.grey, frame.width, frame.height))) break;
  }
  const std::string trouble = source.value()->trouble();
  if (width == 0) return hal::Error{what + ": no frame came" + (trouble.empty() ? "" : ": " + trouble)};
  if (!trouble.empty()) fmt::print(stderr, "warning: {}\n", trouble);
  return {};
}

/// Numbers with commas between, from `least` to `most` of them.
hal::Result<std::vector<double>> numbers_of(const std::string& text, std::size_t least, std::size_t most) {
  std::vector<double> all;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto number = hal::parse_quantity(text.substr(at, end - at), hal::unit::none);
    if (!number.ok()) return number.error();
    all.push_back(number.value());
    at = end + 1;
  }
  if (all.size() < least || all.size() > most)
    return hal::Error{fmt::format("'{}' has {} numbers, not {} to {}", text, all.size(), least, most)};
  return all;
}

/// The corners of a square whose upper edge points to `heading_rad`, as detections have them.
std::array<hal::Vector2, 4> square(const hal::Vector2& centre, double size_m, double heading_rad) {
  const hal::Vector2 up{std::cos(heading_rad), std::sin(heading_rad)}, right{up.y(), -up.x()};
  const double half_m = 0.5 * size_m;
  return {hal::Vector2(centre + half_m * (-right - up)), hal::Vector2(centre + half_m * (right - up)),
          hal::Vector2(centre + half_m * (right + up)), hal::Vector2(centre + half_m * (-right + up))};
}

/// What lies where: known points of each tag, by the tag's number.
struct KnownTag {
  std::vector<hal::Vector3> corners_W;  ///< four, or none
  hal::Vector3 centre_W;
};

hal::Result<std::map<std::size_t, KnownTag>> known_tags(const CalibrateOptions& o, std::string& family) {
  std::map<std::size_t, KnownTag> known;
  if (!o.board.empty()) {
    const auto board = calibration::read_board(o.board);
    if (!board.ok()) return board.error();
    const auto at = numbers_of(o.at.empty() ? "0,0,90" : o.at, 3, 4);
    if (!at.ok()) return hal::Error{"--at: " + at.error().message};
    family = board.value().family;
    const double z_m = at.value().size() > 3 ? at.value()[3] : 0.0;
    const double heading_rad = at.value()[2] * std::numbers::pi / 180.0;
    const hal::Vector2 up{std::cos(heading_rad), std::sin(heading_rad)}, right{up.y(), -up.x()};
    for (std::size_t i = 0; i < board.value().columns * board.value().rows; ++i) {
      const std::size_t id = board.value().first + i;
      KnownTag& tag = known[id];
      tag.centre_W.setZero();
      const auto corners = board.value().corners_m(id);
      for (const hal::Vector2& c : *corners) {
        const hal::Vector2 p = hal::Vector2{at.value()[0], at.value()[1]} + c.x() * right + c.y() * up;
        tag.corners_W.push_back({p.x(), p.y(), z_m});
      }
    }
  }
  const auto size = hal::parse_quantity(o.size, hal::unit::m);
  if (!size.ok()) return hal::Error{"--size: " + size.error().message};
  for (const std::string& text : o.tags) {
    const std::size_t equals = text.find('=');
    std::int64_t id = -1;
    if (equals != std::string::npos) {
      const auto number = hal::parse_quantity(text.substr(0, equals), hal::unit::none);
      if (number.ok() && number.value() >= 0.0 && number.value() < 1e6) id = std::lround(number.value());
    }
    if (id < 0) return hal::Error{"--tag " + text + ": write ID=X,Y[,Z[,DEGREES]], e.g. 100=0.5,-0.5"};
    const auto at = numbers_of(text.substr(equals + 1), 2, 4);
    if (!at.ok()) return hal::Error{"--tag " + text + ": " + at.error().message};
    const std::vector<double>& n = at.value();
    KnownTag tag;
    const double z_m = n.size() > 2 ? n[2] : 0.0;
    tag.centre_W = {n[0], n[1], z_m};
    if (n.size() > 3) {
      for (const hal::Vector2& c : square({n[0], n[1]}, size.value(), n[3] * std::numbers::pi / 180.0))
        tag.corners_W.push_back({c.x(), c.y(), z_m});
    }
    if (!known.emplace(static_cast<std::size_t>(id), tag).second)
      return hal::Error{"--tag " + text + ": it lies somewhere else, too"};
  }
  if (known.empty())
    return hal::Error{"say what lies where: --tag 100=0,0 four times, or --board FILE --at X,Y,DEGREES"};
  return known;
}

/// Where a point was seen, in each of several frames.
hal::Vector2 middle_of(const std::vector<hal::Vector2>& all) {
  std::vector<double> x, y;
  for (const hal::Vector2& p : all) {
    x.push_back(p.x());
    y.push_back(p.y());
  }
  return {hal::upper_median(x), hal::upper_median(y)};
}

int calibrate_board(const CalibrateOptions& o) {
  calibration::Board board;
  const auto size = hal::parse_quantity(o.size, hal::unit::m), gap = hal::parse_quantity(o.gap, hal::unit::m);
  if (!size.ok()) return fail("--size: " + size.error().message);
  if (!gap.ok()) return fail("--gap: " + gap.error().message);
  board.family = o.family;
  board.columns = static_cast<std::size_t>(o.columns);
  board.rows = static_cast<std::size_t>(o.rows);
  board.first = static_cast<std::size_t>(o.first);
  board.size_m = size.value();
  board.gap_m = gap.value();
  if (const hal::Status good = calibration::check_board(board); !good.ok()) return fail(good.error().message);
  const auto format = core::picture_format(o.out);
  if (!format.ok()) return fail(format.error().message);
  if (const hal::Status can = core::can_render(format.value()); !can.ok()) return fail(can.error().message);
  const auto svg = calibration::board_svg(board);
  if (!svg.ok()) return fail(svg.error().message);
  const auto page = core::render(svg.value(), format.value());
  if (!page.ok()) return fail(page.error().message, kFailedRunning);
  const std::string json = std::filesystem::path(o.out).replace_extension(".json").string();
  hal::Status done = keep_old(o.out);
  if (done.ok()) done = keep_old(json);
  if (done.ok()) done = hal::write_whole_file(o.out, "board", page.value());
  if (done.ok()) done = calibration::write_board(json, board);
  if (!done.ok()) return fail(done.error().message, kFailedRunning);
  fmt::print("{}: print it at 100 %, check the line at its foot, glue it onto something flat; {} is for --board\n",
             o.out, json);
  return kDone;
}

int calibrate_camera(const CalibrateOptions& o) {
  const auto board = calibration::read_board(o.board);
  if (!board.ok()) return fail(board.error().message);
  std::vector<calibration::View> views;
  std::size_t width = 0, height = 0;
  std::int64_t seen = 0, alike = 0;
  std::optional<Progress> progress(std::in_place, o.most, 1, "calibrate", "views");
  const hal::Status looked =
      look_at_frames(o.frames, board.value().family, o.every,
                     [&](std::int64_t number, const frames::Frame& frame, std::vector<Detection> tags) {
                       width = frame.width;
                       height = frame.height;
                       ++seen;
                       calibration::View view{fmt::format("frame {}", number), std::move(tags)};
                       if (!calibration::is_of_use(view, board.value())) return true;
                       const bool known = std::any_of(views.begin(), views.end(), [&](const calibration::View& other) {
                         return calibration::are_alike(view, other, board.value());
                       });
                       alike += known ? 1 : 0;
                       if (known) return true;
                       views.push_back(std::move(view));
                       progress->step(static_cast<std::int64_t>(views.size()));
                       return static_cast<std::int64_t>(views.size()) < o.most;
                     });
  progress.reset();
  if (!looked.ok()) return fail(looked.error().message);
  if (views.size() < calibration::kFewestViews)
    return fail(
        fmt::format("{} of {} frames show the board ({} tags at least), {} more are like others; {} are needed, "
                    "15 to 30 are good",
                    views.size(), seen, calibration::kFewestTags, alike, calibration::kFewestViews));
  const auto fit = calibration::fit_lens(views, board.value(), width, height, o.wide);
  if (!fit.ok()) return fail(fit.error().message);
  const auto& f = fit.value();
  for (const std::string& name : f.left_out)
    fmt::print(stderr, "warning: {} does not fit the others: left out\n", name);
  hal::Status written = keep_old(o.out);
  if (written.ok()) written = camera::write_camera_file(o.out, {f.lens, f.rms_px, f.views, {}, 0.0});
  if (!written.ok()) return fail(written.error().message, kFailedRunning);
  fmt::print(
      "{}: from {} views, {:.2f} pixels RMS; focal lengths {:.1f} and {:.1f} (+-{:.1f}), centre {:.1f}, {:.1f} "
      "(+-{:.1f}), distortion {:.4f} {:.4f} {:.5f} {:.5f} {:.4f}; `tandem calibrate arena` is next\n",
      o.out, f.views, f.rms_px, f.lens.fx, f.lens.fy, f.sd_focal_px, f.lens.cx, f.lens.cy, f.sd_centre_px,
      f.lens.distortion[0], f.lens.distortion[1], f.lens.distortion[2], f.lens.distortion[3], f.lens.distortion[4]);
  return kDone;
}

int calibrate_arena(const CalibrateOptions& o) {
  auto file = camera::read_camera_file(o.camera);
  if (!file.ok()) return fail(file.error().message);
  std::string family = o.family;
  const auto known = known_tags(o, family);
  if (!known.ok()) return fail(known.error().message);
  const camera::Lens& lens = file.value().lens;
  std::map<std::size_t, std::array<std::vector<hal::Vector2>, 5>> seen;  // corners, centre
  std::size_t used = 0;
  std::string other_size;
  const hal::Status looked = look_at_frames(
      o.frames, family, 1, [&](std::int64_t, const frames::Frame& frame, const std::vector<Detection>& tags) {
        if (frame.width != lens.width || frame.height != lens.height) {
          other_size = fmt::format("frames are {}x{}, and {} is of {}x{}", frame.width, frame.height, o.camera,
                                   lens.width, lens.height);
          return false;
        }
        for (const Detection& tag : tags) {
          if (!known.value().contains(tag.id)) continue;
          for (std::size_t i = 0; i < 4; ++i) seen[tag.id][i].push_back(tag.corners[i]);
          seen[tag.id][4].push_back(tag.centre());
        }
        return ++used < kFramesOfArena;
      });
  if (!looked.ok()) return fail(looked.error().message);
  if (!other_size.empty()) return fail(other_size);
  std::vector<calibration::KnownPoint> points;
  for (const auto& [id, pixels] : seen) {
    const KnownTag& tag = known.value().at(id);
    const std::string name = fmt::format("tag {}", id);
    for (std::size_t i = 0; i < tag.corners_W.size(); ++i)
      points.push_back({name, tag.corners_W[i], middle_of(pixels[i])});
    if (tag.corners_W.empty()) points.push_back({name, tag.centre_W, middle_of(pixels[4])});
  }
  const auto fit = calibration::fit_place(lens, points);
  if (!fit.ok())
    return fail(fmt::format("{} of {} tags were seen: {}", seen.size(), known.value().size(), fit.error().message));
  const auto& f = fit.value();
  file.value().place = f.place;
  file.value().place_residual_px = f.rms_px;
  const std::string out = o.out.empty() ? o.camera : o.out;
  hal::Status written = keep_old(out);
  if (written.ok()) written = camera::write_camera_file(out, file.value());
  if (!written.ok()) return fail(written.error().message, kFailedRunning);
  const hal::Vector3 forward = f.place.q_WC * hal::Vector3::UnitZ();
  fmt::print(
      "{}: the camera hangs at {:.3f}, {:.3f}, {:.3f} m (+-{:.1f} mm), {:.1f} degrees from straight down; {} tags, "
      "{:.2f} pixels RMS; {} fits worst, by {:.1f} mm\n",
      out, f.place.p_WC.x(), f.place.p_WC.y(), f.place.p_WC.z(), 1e3 * f.sd_m,
      std::acos(std::clamp(-forward.z(), -1.0, 1.0)) * 180.0 / std::numbers::pi, seen.size(), f.rms_px, f.worst,
      1e3 * f.worst_m);
  return kDone;
}

}  // namespace

constinit const hal::CommandType calibrate_board_command =
    module_command<BoardOptions, calibrate_board>("calibrate board");
constinit const hal::CommandType calibrate_camera_command =
    module_command<CameraOptions, calibrate_camera>("calibrate camera");
constinit const hal::CommandType calibrate_arena_command =
    module_command<ArenaOptions, calibrate_arena>("calibrate arena");

}  // namespace tandem::app
