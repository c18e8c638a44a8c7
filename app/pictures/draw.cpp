#include <algorithm>
#include <csignal>
#include <fmt/format.h>
#include <optional>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/pictures/pictures.hpp"
#include "app/process/progress.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "core/view/layers/layer_set.hpp"
#include "core/view/picture.hpp"
#include "core/view/record_drawing.hpp"
#include "hal/json/json_access.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

struct DrawOptions {
  std::string record;
  PictureRequest pictures;
  std::optional<std::int64_t> at;  ///< number of ticks; empty: the last that the record holds
};

struct PictureOptions : DrawOptions {
  void describe(hal::CommandLine& line) {
    line.word("record", record, "The record; that of a run that was killed is FILE.part").required().file();
    line.option("--at", at, "After so many ticks; default: the last that the record holds").not_negative();
    line.option("-o,--picture", pictures.picture, "FILE.svg, .png or .pdf").file();
    line.option("--povray", pictures.povray, "A scene in perspective: FILE.pov, or FILE.png to render that, too")
        .file();
    line.choose({"output", "Where to", 1, 2, {"-o,--picture", "--povray"}});
    describe_looks(line, pictures);
  }
};

struct FilmOptions : DrawOptions {
  void describe(hal::CommandLine& line) {
    line.word("record", record, "The record; that of a run that was killed is FILE.part").required().file();
    line.option("-o,--film", pictures.film, "FILE.mp4, .mkv or .webp (ffmpeg), or pictures: FOLDER/ or FOLDER/%06d.png")
        .required()
        .file();
    describe_film(line, "--film", pictures);
    describe_looks(line, pictures);
  }
};

/// Opens a file that is asked for; none where not.
hal::Result<std::optional<hal::OutputFile>> open_file(const std::string& path, std::string_view what) {
  if (path.empty()) return std::optional<hal::OutputFile>();
  auto file = hal::OutputFile::open(path, what);
  if (!file.ok()) return file.error();
  return std::optional<hal::OutputFile>(std::move(file).value());
}

/// A record as it is drawn.
struct Drawn {
  std::unique_ptr<KindsOfFile> known;  // that its run knew
  core::RecordSource record;
  core::PictureLook look;
  std::unique_ptr<core::LayerSet> layers;  // null: none

  static hal::Result<Drawn> open(const std::string& path, const PictureRequest& request);
  /// At every tick: for layers that depend on the past.
  void note() {
    if (layers != nullptr && record.ticks_done() > 0) layers->note(record.observation());
  }
  core::Drawing drawing(const core::Trails& trails) {
    core::Drawing drawing = core::drawing_of(record, look, &trails);
    if (layers != nullptr) draw_layers(*layers, record.observation(), drawing);
    return drawing;
  }
  void tell_damage(const std::string& path) const {
    for (const std::string& line : record.moments().damage()) say("record '" + path + "': " + line);
  }
};

hal::Result<Drawn> Drawn::open(const std::string& path, const PictureRequest& request) {
  auto reader = core::RecordReader::open(path);
  if (!reader.ok()) return reader.error();
  auto known = kinds_of_settings(hal::text_of(reader.value().start(), "settings"), path);
  auto record = core::RecordSource::open(path, &known->catalog);
  if (!record.ok()) return record.error();
  auto look = look_of(request, core::arena_of(record.value().space()));
  if (!look.ok()) return look.error();
  auto layers = layers_of(request, known->catalog);
  if (!layers.ok()) return layers.error();
  return Drawn{std::move(known), std::move(record).value(), look.value(), std::move(layers).value()};
}

/// Goes to the tick that was asked for, and keeps trails on the way. Error: the record does not hold it; those beside
/// it.
hal::Status go_to(const DrawOptions& options, Drawn& drawn, core::Trails& trails) {
  core::RecordSource& record = drawn.record;
  trails.note(record.ticks_done(), record.space());
  std::optional<std::int64_t> before;
  while (!options.at || record.ticks_done() != *options.at) {
    const std::int64_t here = record.ticks_done();
    const bool passed = options.at && here > *options.at;
    if (!passed && record.next()) {
      before = here;
      if (trails.wants(record.ticks_done())) trails.note(record.ticks_done(), record.space());
      drawn.note();
      continue;
    }
    if (!options.at) return {};
    std::string near = fmt::format("{}", here);
    if (passed && before) near = fmt::format("{} and {}", *before, here);
    return hal::Error{fmt::format("record '{}' does not hold what was after {} ticks; near that it has {}",
                                  options.record, *options.at, near)};
  }
  return {};
}

int draw_picture(const DrawOptions& options) {
  const PictureRequest& request = options.pictures;
  if (const hal::Status can = check_pictures(request); !can.ok()) return complain(kBadInput, can.error().message);
  const std::string scene = request.povray.empty() ? std::string() : scene_of(request.povray);
  const hal::Status apart = check_apart({{"picture", request.picture},
                                         {"scene", scene},
                                         {"picture by POV-Ray", request.povray == scene ? "" : request.povray}},
                                        {{"record", options.record}});
  if (!apart.ok()) return complain(kBadInput, apart.error().message);
  auto opened = Drawn::open(options.record, request);
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  Drawn& drawn = opened.value();
  core::Trails trails(drawn.look.trails_s, drawn.record.ticks_per_second());
  if (const hal::Status there = go_to(options, drawn, trails); !there.ok())
    return complain(kBadInput, there.error().message);
  auto picture = open_file(request.picture, "picture");
  if (!picture.ok()) return complain(kBadInput, picture.error().message);
  auto scene_file = open_file(scene, "scene");
  if (!scene_file.ok()) return complain(kBadInput, scene_file.error().message);

  const core::Drawing drawing = drawn.drawing(trails);
  drawn.tell_damage(options.record);
  hal::Status done;
  if (picture.value()) done = core::write_picture(drawing, *picture.value(), drawn.look);
  if (done.ok() && scene_file.value()) done = write_scene(drawing, drawn.look, *scene_file.value(), request.povray);
  return done.ok() ? kDone : complain(kFailedRunning, done.error().message);
}

int draw_film(const DrawOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);  // the encoder may end before us
  const std::atomic<bool>& stop = catch_signals();
  if (const hal::Status can = check_pictures(options.pictures); !can.ok())
    return complain(kBadInput, can.error().message);
  const hal::Status apart = check_apart({{"film", options.pictures.film}}, {{"record", options.record}});
  if (!apart.ok()) return complain(kBadInput, apart.error().message);

  // Once through the record, for its length; then the frames.
  auto first = core::RecordSource::open(options.record);
  if (!first.ok()) return complain(kBadInput, first.error().message);
  std::int64_t frames = 1, ticks = first.value().ticks_done();
  for (; !stop.load() && first.value().next(); ++frames) ticks = std::max(ticks, first.value().ticks_done());
  PictureRequest request = options.pictures;
  request.film_every = std::max(
      request.film_every, (ticks + frames / 2) / std::max<std::int64_t>(1, frames - 1));  // of a record of some ticks
  auto opened = Drawn::open(options.record, request);
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  Drawn& drawn = opened.value();
  core::RecordSource& record = drawn.record;
  auto made = Pictures::open(request, drawn.look, record.ticks_per_second(), ticks, stop);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  Pictures& pictures = *made.value();
  std::optional<Progress> progress(std::in_place, ticks, record.ticks_per_second(), "film");
  do {
    progress->step(pictures.drawn_until());
    if (pictures.trails().wants(record.ticks_done())) pictures.note(record.ticks_done(), record.space());
    drawn.note();
    if (pictures.wants(record.ticks_done())) pictures.draw(record.ticks_done(), drawn.drawing(pictures.trails()));
  } while (!stop.load() && record.next());
  progress.reset();
  drawn.tell_damage(options.record);
  const bool good = pictures.close();
  if (stop.load()) return interrupted_code();
  return good ? kDone : kFailedRunning;
}

}  // namespace

constinit const hal::CommandType picture_command = module_command<PictureOptions, draw_picture>("picture");
constinit const hal::CommandType film_command = module_command<FilmOptions, draw_film>("film");

}  // namespace tandem::app
