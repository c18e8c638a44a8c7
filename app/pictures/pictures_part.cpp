#include "app/pictures/pictures_part.hpp"

#include <optional>
#include <string>
#include <tuple>

#include "app/outputs/observers.hpp"
#include "app/pictures/pictures.hpp"
#include "app/process/terminal.hpp"
#include "app/run/run_plan.hpp"
#include "core/view/layers/layer_set.hpp"
#include "core/view/picture.hpp"
#include "core/view/record_drawing.hpp"

namespace tandem::app {
namespace {

/// Draws on the way and at the end.
class Drawings final : public core::RunPart {
 public:
  explicit Drawings(RunPlan& plan) : plan_(plan) {}
  /// Opens the files. Error: one cannot be written, or its layers are not there.
  hal::Status open();

  std::string_view name() const override { return "pictures"; }
  core::RunTurn turn() const override { return core::RunTurn::Outputs; }
  hal::Status join(core::Run&) override {
    draw();
    return {};
  }
  bool after_tick(core::Run& run) override {
    const hal::Tick done = run.world().tick();
    if (done == 0) return true;  // a hook went back to the start
    const std::lock_guard hold(plan_.watchdog->lock());
    if (layers_ != nullptr) layers_->note(observation_of(run.world(), done - 1));
    draw();
    return true;
  }
  /// Before the report is written: what fails here is a failure of the run.
  hal::Status close(core::Run&) override {
    if (pictures_ != nullptr && !pictures_->close()) plan_.written = false;
    const core::PictureOptions options = picture_options();
    if (picture_) check(core::write_picture(drawing_of(options), *picture_, look_));
    if (scene_)
      check(write_scene(core::drawing_of(world().space(), options), look_, *scene_, plan_.options.pictures.povray));
    plan_.outputs.at_the_end.clear();
    return {};
  }
  /// As it is now.
  core::Drawing drawing() const { return drawing_of(picture_options()); }

 private:
  const core::World& world() const { return *plan_.world; }
  void check(const hal::Status& written) {
    if (!written.ok()) plan_.written = complain(kFailedRunning, written.error().message) == kDone;
  }
  void draw();
  core::PictureOptions picture_options() const;
  core::Drawing drawing_of(const core::PictureOptions& options) const;

  RunPlan& plan_;
  core::PictureLook look_;
  std::unique_ptr<Pictures> pictures_;  // on the way
  std::unique_ptr<core::LayerSet> layers_;
  std::optional<hal::OutputFile> picture_, scene_;
};

hal::Status Drawings::open() {
  const PictureRequest& request = plan_.options.pictures;
  auto look = look_of(request, core::arena_of(world().space()));
  if (!look.ok()) return look.error();
  look_ = look.value();
  if (Pictures::asked(request)) {
    auto pictures = Pictures::open(request, look_, world().ticks_per_second(), plan_.steps, *plan_.stop);
    if (!pictures.ok()) return pictures.error();
    pictures_ = std::move(pictures).value();
  }
  auto layers = layers_of(request, plan_.loader.catalog());
  if (!layers.ok()) return layers.error();
  layers_ = std::move(layers).value();
  const std::string scene = request.povray.empty() ? std::string() : scene_of(request.povray);
  for (const auto& [what, path, file] :
       {std::tuple{"picture", &request.picture, &picture_}, std::tuple{"scene", &scene, &scene_}}) {
    if (path->empty()) continue;
    auto opened = hal::OutputFile::open(*path, what);
    if (!opened.ok()) return opened.error();
    *file = std::move(opened).value();
    plan_.outputs.at_the_end.push_back(&**file);
  }
  return {};
}

void Drawings::draw() {
  if (pictures_ == nullptr) return;
  const hal::Tick done = world().tick();
  pictures_->note(done, world().space());
  if (pictures_->wants(done)) pictures_->draw(done, drawing());
}

/// What a picture of the world says besides where everything is.
core::PictureOptions Drawings::picture_options() const {
  core::PictureOptions picture;
  picture.experiment = world().scenario().name;
  picture.seed = world().seed();
  picture.time_ns = hal::time_of_tick(world().tick(), world().ticks_per_second());
  picture.look = look_;
  picture.ticks_done = world().tick();
  if (plan_.real != nullptr) {
    for (auto& [robot, why] : plan_.real->troubles()) picture.trouble.push_back({robot, std::move(why)});
  }
  if (pictures_ != nullptr) picture.trails = &pictures_->trails();
  return picture;
}

/// The world, with the layers that were asked for.
core::Drawing Drawings::drawing_of(const core::PictureOptions& options) const {
  core::Drawing drawing = core::drawing_of(world().space(), options);
  drawing.areas = core::areas_of(world().scenario().safety);
  const hal::Tick last = world().tick() == 0 ? 0 : world().tick() - 1;
  if (layers_ != nullptr) draw_layers(*layers_, observation_of(world(), last), drawing);
  return drawing;
}

}  // namespace

hal::Result<std::vector<NamedFile>> picture_files(const RunOptions& options) {
  const PictureRequest& request = options.pictures;
  if (const hal::Status pictures = check_pictures(request); !pictures.ok()) return pictures.error();
  std::vector<NamedFile> files = {{"picture", request.picture}, {"picture by POV-Ray", request.povray}};
  if (request.povray.ends_with(".png")) files.push_back({"scene", scene_of(request.povray)});
  if (!request.film.ends_with('/')) files.push_back({"film", request.film});
  for (const std::int64_t tick : request.at)
    files.push_back({"picture at tick " + std::to_string(tick), picture_at(request.picture, tick)});
  return files;
}

int open_pictures(RunPlan& plan) {
  auto drawings = std::make_unique<Drawings>(plan);
  if (const hal::Status opened = drawings->open(); !opened.ok()) return complain(kBadInput, opened.error().message);
  plan.drawing = [&drawings = *drawings] { return drawings.drawing(); };
  plan.opened.push_back(std::move(drawings));
  return kDone;
}

int add_pictures(RunPlan& plan, core::Run& run) {
  for (auto& part : std::exchange(plan.opened, {})) run.add(std::move(part));
  return kDone;
}

}  // namespace tandem::app
