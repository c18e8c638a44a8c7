#include "app/pictures/pictures.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "app/process/measure.hpp"
#include "app/process/progress.hpp"
#include "app/process/terminal.hpp"
#include "core/view/film.hpp"
#include "core/view/picture.hpp"
#include "core/view/povray.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"

namespace tandem::app {
namespace {

constexpr std::int64_t kMostFrames = 100'000;
constexpr std::size_t kMostWaiting_bytes = std::size_t{256} << 20;
constexpr double kFrame_s = 0.1;           // a guess, before one was drawn
constexpr std::int64_t kTriedFrames = 10;  // after which the time of the rest is known
constexpr double kLong_s = 60.0;           // that is worth a word

/// Of memory, about.
std::size_t bytes_of(const core::Drawing& d) {
  return 4096 + sizeof(core::Drawing::Robot) * d.robots.size() + sizeof(core::Drawing::LitLamp) * d.lit.size() +
         sizeof(double) * d.values.size() + sizeof(core::Drawing::Point) * d.trail_points.size() +
         sizeof(std::string) * d.ids.size() + sizeof(core::Object) * d.objects.size() +
         sizeof(core::Sketch::Shape) * d.shapes.size();
}

/// "90 s", "25 min", "3.5 h"
std::string about(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
  return seconds < 7200.0 ? fmt::format("{:.0f} min", seconds / 60.0) : fmt::format("{:.1f} h", seconds / 3600.0);
}

}  // namespace

hal::Status check_pictures(const PictureRequest& request) {
  if (!request.picture.empty()) {
    const auto format = core::picture_format(request.picture);
    if (!format.ok()) return hal::Error{"--picture: " + format.error().message};
    if (const hal::Status renderer = core::can_render(format.value()); !renderer.ok()) return renderer;
  }
  if (!request.povray.empty()) {
    const std::string ending = std::filesystem::path(request.povray).extension().string();
    if (ending != ".pov" && ending != ".png")
      return hal::Error{"--povray: the scene '" + request.povray + "' must end in .pov, or in .png to be rendered"};
    const hal::Status can = ending == ".png" ? core::can_render_povray() : hal::Status{};
    if (!can.ok()) return hal::Error{"--povray: " + can.error().message};
  }
  if (request.film.empty()) return {};
  const hal::Status film = core::Film::can_make(request.film);
  return film.ok() ? film : hal::Status(hal::Error{"--film: " + film.error().message});
}

hal::Result<core::PictureLook> look_of(const PictureRequest& request, const core::PictureLook::Area& arena) {
  core::PictureLook look;
  look.size_px = static_cast<int>(request.size_px);
  look.trails_s = request.trails_s;
  look.axes = request.axes;
  look.title = !request.no_title;
  look.legend = !request.no_legend;
  look.ids = request.ids;
  if (request.region.empty()) return look;
  const core::PictureLook::Area region{request.region.at(0), request.region.at(1), request.region.at(2),
                                       request.region.at(3)};
  const auto text = [](const core::PictureLook::Area& a) {
    return hal::rounded(a.min_x_m) + "," + hal::rounded(a.min_y_m) + "," + hal::rounded(a.max_x_m) + "," +
           hal::rounded(a.max_y_m);
  };
  if (!(region.min_x_m < region.max_x_m) || !(region.min_y_m < region.max_y_m))
    return hal::Error{"--picture-region " + text(region) +
                      ": the first corner must lie left of the second one and beneath it"};
  if (region.min_x_m >= arena.max_x_m || region.max_x_m <= arena.min_x_m || region.min_y_m >= arena.max_y_m ||
      region.max_y_m <= arena.min_y_m)
    return hal::Error{"--picture-region " + text(region) + " lies outside of the arena, which is " + text(arena)};
  look.region = region;
  return look;
}

std::string picture_at(const std::string& picture, std::int64_t ticks_done) {
  const std::string ending = std::filesystem::path(picture).extension().string();
  return fmt::format("{}-{:06}{}", picture.substr(0, picture.size() - ending.size()), ticks_done, ending);
}

std::string scene_of(const std::string& povray) {
  return std::filesystem::path(povray).replace_extension(".pov").string();
}

hal::Result<std::unique_ptr<core::LayerSet>> layers_of(const PictureRequest& request, const hal::Catalog& catalog) {
  std::unique_ptr<core::LayerSet> layers;
  if (request.layers.empty()) return layers;
  if (request.picture.empty() && request.film.empty())
    return hal::Error{"--picture-layers needs --picture or --film: what the layers are drawn over"};
  layers = std::make_unique<core::LayerSet>(
      catalog, hal::Log([](hal::Severity, std::string_view text) { complain(kFailedRunning, std::string(text)); }));
  if (const hal::Status on = layers->switch_on(request.layers); !on.ok())
    return hal::Error{"--picture-layers: " + on.error().message};
  for (const std::size_t i : layers->on()) {
    if (!layers->types()[i]->draws)
      return hal::Error{"--picture-layers: the layer '" + std::string(layers->types()[i]->name) +
                        "' has a panel alone; pictures show what layers draw"};
  }
  return layers;
}

void draw_layers(core::LayerSet& layers, const core::Observation& now, core::Drawing& drawing) {
  for (const core::LayerPicture& layer : layers.show(now))
    drawing.shapes.insert(drawing.shapes.end(), layer.sketch.shapes().begin(), layer.sketch.shapes().end());
}

hal::Status write_scene(const core::Drawing& drawing, const core::PictureLook& look, hal::OutputFile& file,
                        const std::string& povray) {
  hal::Status done = file.write(core::to_povray(drawing, look));
  if (done.ok()) done = file.commit();
  if (!done.ok() || scene_of(povray) == povray) return done;
  return core::render_povray(file.path(), povray, look.size_px);
}

struct Pictures::Impl {
  const std::atomic<bool>* stop = nullptr;
  PictureRequest request;
  core::PictureLook look;
  std::int64_t ticks = 0, ticks_per_second = 10;
  std::set<std::int64_t> at;  // that are to come
  std::unique_ptr<core::Film> film;
  std::int64_t film_frames = 0;  // that were handed over
  bool film_full = false;
  std::int64_t last_frame = -1;  // ticks that were done then

  bool wants_frame(std::int64_t ticks_done) const noexcept {
    return film != nullptr && !film_full &&
           (last_frame < 0 || ticks_done < last_frame || ticks_done - last_frame >= request.film_every);
  }
  std::uint64_t floor_mark = 0;
  std::function<double(double, double)> floor;  // kept, of that mark
  std::function<hal::Rgb(double, double)> floor_color;

  // Between the thread that hands over and the one that draws.
  std::mutex mutex;
  std::condition_variable changed;
  struct Job {
    std::int64_t ticks_done = 0;
    std::size_t bytes = 0;
    std::function<void()> draw;
  };
  std::deque<Job> jobs;
  std::size_t waiting_bytes = 0;  // with those that are being drawn
  std::int64_t drawn_until = 0;   // ticks that were done then
  bool over = false;
  bool begun = false;  // to draw
  bool cut = false;    // something was left out
  std::thread artist;

  // Of the thread that draws.
  hal::Status film_status;
  bool failed = false;
  double film_s = 0.0;

  void complain_once(const hal::Status& status) {
    if (status.ok()) return;
    failed = true;
    complain(kFailedRunning, status.error().message);
  }
  void add_frame(const core::Drawing& drawing);
  void write_picture(const core::Drawing& drawing, const std::string& path);
  void add(std::int64_t ticks_done, std::size_t bytes, std::function<void()> draw);
  void wait_for_change(std::unique_lock<std::mutex>& lock);
  void work();
  void finish();
  void show_progress();
};

void Pictures::Impl::add_frame(const core::Drawing& drawing) {
  if (!film_status.ok()) return;
  const double began_s = wall_seconds();
  film_status = film->add(drawing);
  film_s += wall_seconds() - began_s;
  if (!film_status.ok()) {
    complain_once(hal::Error{film_status.error().message + "; it goes on without the film"});
    return;
  }
  const std::int64_t all = ticks / request.film_every + 1;
  if (film->frames() != kTriedFrames || ticks == 0) return;
  const double rest_s = film_s / kTriedFrames * static_cast<double>(all - kTriedFrames);
  if (rest_s > kLong_s)
    say(fmt::format("the film's {} frames take about {}; --film-every and --picture-size make that less", all,
                    about(rest_s)));
}

void Pictures::Impl::write_picture(const core::Drawing& drawing, const std::string& path) {
  const auto rendered = core::render(core::to_svg(drawing, look), core::picture_format(path).value());
  complain_once(rendered.ok() ? hal::write_whole_file(path, "picture", rendered.value()) : rendered.error());
}

/// Until something was drawn, or for a moment. After a stop what waits is left out.
void Pictures::Impl::wait_for_change(std::unique_lock<std::mutex>& lock) {
  (void)changed.wait_for(lock, std::chrono::milliseconds(200));
  if (!stop->load(std::memory_order_relaxed)) return;
  while (jobs.size() > (begun ? 0U : 1U)) {  // a film has one frame at least
    waiting_bytes -= jobs.back().bytes;
    jobs.pop_back();
    cut = true;
  }
}

void Pictures::Impl::add(std::int64_t ticks_done, std::size_t bytes, std::function<void()> draw) {
  std::unique_lock lock(mutex);
  while (waiting_bytes > 0 && waiting_bytes + bytes > kMostWaiting_bytes) wait_for_change(lock);
  jobs.push_back({ticks_done, bytes, std::move(draw)});
  waiting_bytes += bytes;
  changed.notify_all();
}

void Pictures::Impl::work() {
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [this] { return over || !jobs.empty(); });
    if (jobs.empty()) return;
    Job job = std::move(jobs.front());
    jobs.pop_front();
    begun = true;
    lock.unlock();
    try {
      job.draw();
    } catch (const std::exception& e) {
      complain_once(hal::Error{"a picture could not be drawn: " + std::string(e.what())});
    }
    job.draw = nullptr;
    lock.lock();
    waiting_bytes -= job.bytes;
    drawn_until = job.ticks_done;
    changed.notify_all();
  }
}

void Pictures::Impl::finish() {
  {
    std::unique_lock lock(mutex);
    while (waiting_bytes > 0) wait_for_change(lock);
    over = true;
    changed.notify_all();
  }
  if (artist.joinable()) artist.join();
}

/// Of the drawing that is left when the ticks are over, until it is done.
void Pictures::Impl::show_progress() {
  if (film == nullptr || ticks == 0) return;
  Progress progress(ticks, ticks_per_second, "film");
  std::unique_lock lock(mutex);
  while (waiting_bytes > 0) {
    wait_for_change(lock);
    progress.step(drawn_until);
  }
}

bool Pictures::asked(const PictureRequest& request) noexcept {
  return !request.film.empty() || !request.at.empty() || (!request.picture.empty() && request.trails_s > 0.0);
}

hal::Result<std::unique_ptr<Pictures>> Pictures::open(const PictureRequest& request, const core::PictureLook& look,
                                                      std::int64_t ticks_per_second, std::int64_t ticks,
                                                      const std::atomic<bool>& stop) {
  auto impl = std::make_unique<Impl>();
  impl->stop = &stop;
  impl->request = request;
  impl->look = look;
  impl->ticks = ticks;
  impl->ticks_per_second = ticks_per_second;
  impl->at.insert(request.at.begin(), request.at.end());
  if (ticks > 0 && !impl->at.empty() && *impl->at.rbegin() > ticks)
    return hal::Error{fmt::format("--picture-at {}: there are {} ticks", *impl->at.rbegin(), ticks)};
  if (!request.film.empty()) {
    const std::int64_t frames = ticks / request.film_every + 1;
    if (frames > kMostFrames) {
      return hal::Error{fmt::format(
          "--film: {} frames would take about {} to draw; {} at most: take a frame every {} ticks (--film-every {})",
          frames, about(kFrame_s * static_cast<double>(frames)), kMostFrames,
          (ticks + kMostFrames - 2) / (kMostFrames - 1), (ticks + kMostFrames - 2) / (kMostFrames - 1))};
    }
    const double real_rate = static_cast<double>(ticks_per_second) / static_cast<double>(request.film_every);
    auto film = core::Film::open(
        {request.film, request.film_rate > 0.0 ? request.film_rate : std::clamp(real_rate, 0.1, 60.0), look});
    if (!film.ok()) return film.error();
    impl->film = std::move(film).value();
  }
  std::unique_ptr<Pictures> pictures(new Pictures(core::Trails(look.trails_s, ticks_per_second)));
  impl->artist = std::thread([&impl = *impl] { impl.work(); });
  pictures->impl_ = std::move(impl);
  return pictures;
}

Pictures::Pictures(core::Trails trails) : trails_(std::move(trails)) {}

Pictures::~Pictures() {
  if (impl_ != nullptr) impl_->finish();
}

bool Pictures::wants(std::int64_t ticks_done) const noexcept {
  return impl_->wants_frame(ticks_done) || impl_->at.contains(ticks_done);
}

void Pictures::draw(std::int64_t ticks_done, core::Drawing drawing) {
  Impl& p = *impl_;
  if (drawing.floor) {
    if (!p.floor || p.floor_mark != drawing.floor_mark) {
      core::keep_floor(drawing, p.look);
      p.floor = drawing.floor;
      p.floor_color = drawing.floor_color;
      p.floor_mark = drawing.floor_mark;
    }
    drawing.floor = p.floor;
    drawing.floor_color = p.floor_color;
  }
  const std::size_t bytes = bytes_of(drawing);
  const bool frame = p.wants_frame(ticks_done);
  if (frame) p.last_frame = ticks_done;
  const bool picture = p.at.erase(ticks_done) > 0;
  if (frame && ++p.film_frames == kMostFrames) p.film_full = true;
  p.add(ticks_done, bytes, [&p, frame, picture, ticks_done, drawing = std::move(drawing)] {
    if (frame) p.add_frame(drawing);
    if (picture) p.write_picture(drawing, picture_at(p.request.picture, ticks_done));
  });
  if (frame && p.film_full && p.ticks == 0)
    say(fmt::format("the film ends here: it has {} frames; --film-every makes them fewer", kMostFrames));
}

std::int64_t Pictures::drawn_until() const {
  const std::lock_guard hold(impl_->mutex);
  return impl_->drawn_until;
}

bool Pictures::close() {
  Impl& p = *impl_;
  p.show_progress();
  p.finish();
  if (p.cut) say(fmt::format("interrupted: pictures and film end after tick {}", p.drawn_until));
  if (p.film != nullptr && p.film_status.ok()) p.complain_once(p.film->close());
  if (p.film != nullptr && !p.failed) {
    if (const std::string remark = p.film->remark(); !remark.empty()) say(remark);
  }
  if (!p.at.empty()) say(fmt::format("--picture-at {}: it ended before", *p.at.begin()));
  return !p.failed;
}

}  // namespace tandem::app
