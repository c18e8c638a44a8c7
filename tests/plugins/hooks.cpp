// Hooks that tests need.
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "core/hook/hook.hpp"
#include "core/space/space.hpp"
#include "tests/plugins/shown.hpp"

namespace {

using namespace tandem;

/// Notes its calls in a file that the test names.
class Diary final : public core::Hook {
 public:
  struct Params {
    std::string path;
    std::int64_t done_at = -1;
    std::int64_t throw_at = -1;
    bool shift = false;
    void describe(hal::ParamVisitor& v) {
      v.text("path", path, "File to write the calls to.");
      v.integer("done_at", done_at, hal::kAny, "Ends the run before this tick.");
      v.integer("throw_at", throw_at, hal::kAny, "Throws before this tick.");
      v.flag("shift", shift, "Moves the first robot by 1 m in y before tick 2.");
    }
  };
  explicit Diary(const Params& params) : params_(params), out_(params.path) {}
  void before_run(core::HookContext& c) override { out_ << "before_run " << c.space.robot_count() << "\n"; }
  void before_step(core::HookContext& c) override {
    if (c.tick == params_.throw_at) throw std::runtime_error("no more");
    if (params_.shift && c.tick == 2) {
      core::Pose pose = c.space.pose(c.space.robot(0));
      pose.y_m += 1.0;
      c.space.set_pose(c.space.robot(0), pose);
    }
    out_ << "before_step " << c.tick << "\n";
  }
  void after_step(core::HookContext& c) override { out_ << "after_step " << c.tick << "\n"; }
  bool is_done(core::HookContext& c) override { return c.tick == params_.done_at; }
  void after_run(core::HookContext& c) override { out_ << "after_run " << c.tick << "\n"; }
  std::optional<double> floor(double x_m, double /*y_m*/) override { return x_m > 0.0 ? 1.0 : 0.0; }

 private:
  Params params_;
  std::ofstream out_;
};

/// Paints the floor as light as its control says, which the file sets; remembers nothing.
class Dial final : public core::Hook {
 public:
  struct Params {
    double level = 0.25;
    void describe(hal::ParamVisitor& v) { v.number("level", level, hal::unit::none, {0.0, 1.0}, "How light."); }
  };
  explicit Dial(const Params& params) : level_(params.level) {}
  void after_step(core::HookContext& c) override { c.measures.set("level", level_); }
  std::optional<double> floor(double /*x_m*/, double /*y_m*/) override { return level_; }
  void controls(core::HookContext&, hal::Controls& controls) override {
    (void)controls.number("level", level_, hal::unit::none, {0.0, 1.0}, "How light.");
  }
  bool remember(hal::Archive&) override { return true; }

 private:
  double level_;
};

/// Brings robots and boxes in and takes them out again; keeps a moment and goes back to it.
class Shepherd final : public core::Hook {
 public:
  struct Params {
    std::string controller = "c";
    std::int64_t save_at = -1;
    std::int64_t back_at = -1;
    std::int64_t times = 1;
    bool movable = false;
    void describe(hal::ParamVisitor& v) {
      v.text("controller", controller, "Configuration of the robots.");
      v.integer("save_at", save_at, hal::kAny, "Keeps the moment after this tick.");
      v.integer("back_at", back_at, hal::kAny, "Goes back to it after this tick.");
      v.integer("times", times, hal::kAny, "How often.");
      v.flag("movable", movable, "Its boxes can be pushed.");
    }
  };
  explicit Shepherd(const Params& params) : params_(params) {}

  void before_step(core::HookContext& c) override {
    if (c.tick % 3 == 0) come(c);
    if (c.tick % 4 == 3 && !flock_.empty()) {
      c.space.remove_robot(flock_.front());
      flock_.erase(flock_.begin());
    }
    if (c.tick % 10 == 5) c.space.remove_object(box_);
  }

  void after_step(core::HookContext& c) override {
    if (c.tick == params_.save_at && went_back_ == 0) c.checkpoints.save("fold");
    if (c.tick == params_.back_at && went_back_ < params_.times) {
      ++went_back_;
      const hal::Status asked = c.checkpoints.restore("fold");
      if (!asked.ok()) throw std::runtime_error(asked.error().message);
    }
  }

  std::any save() const override { return Memory{flock_, box_, came_}; }
  void restore(const std::any& saved) override {
    const auto& memory = std::any_cast<const Memory&>(saved);
    flock_ = memory.flock;
    box_ = memory.box;
    came_ = memory.came;
  }

 private:
  struct Memory {
    std::vector<core::RobotId> flock;
    core::ObjectId box;
    int came;
  };

  void come(core::HookContext& c) {
    const double x_m = -1.5 + 0.3 * (came_ % 11);
    const auto robot = c.space.add_robot({.kind = "e-puck",
                                          .id = "sheep" + std::to_string(came_),
                                          .controller = params_.controller,
                                          .pose = core::Pose::at(x_m, 1.6, 0.1 * came_),
                                          .params = {{"left", "0.03"}}});
    if (robot.ok()) flock_.push_back(robot.value());
    core::Object box;
    box.id = "hurdle" + std::to_string(came_);
    box.x_m = x_m;
    box.y_m = -1.6;
    box.half_x_m = box.half_y_m = 0.05;
    box.z_high_m = 0.2;
    box.movable = params_.movable;
    ++came_;
    if (c.space.contains(box_)) return;
    const auto added = c.space.add_object(box);
    if (added.ok()) box_ = added.value();
  }

  Params params_;
  std::vector<core::RobotId> flock_;
  core::ObjectId box_;
  int came_ = 0;
  std::int64_t went_back_ = 0;  // survives going back
};

/// Paints a disc, on the floor or another field.
class Painter final : public core::Hook {
 public:
  struct Params {
    double x_m = 0.0, radius_m = 0.5, shade = 0.0;
    std::string fails, field = "floor";
    void describe(hal::ParamVisitor& v) {
      v.text("field", field, "What it paints.");
      v.number("x", x_m, hal::unit::m, hal::kAny, "Its middle.");
      v.number("radius", radius_m, hal::unit::m, hal::kNotNegative, "Its radius.");
      v.number("shade", shade, hal::unit::none, {0.0, 1.0}, "How light.");
      v.text("fails", fails, "Where it throws: params, constructor or floor.");
      if (fails == "params") throw std::runtime_error("no such brush");
    }
  };
  explicit Painter(const Params& params) : params_(params) {
    if (params.fails == "constructor") throw std::runtime_error("no paint");
  }
  std::optional<double> floor(double x_m, double y_m) override {
    if (params_.fails == "floor") throw std::runtime_error("spilt");
    if (std::hypot(x_m - params_.x_m, y_m) > params_.radius_m) return std::nullopt;
    return params_.shade;
  }
  std::optional<double> field(std::string_view name, double x_m, double y_m) override {
    return name == params_.field ? floor(x_m, y_m) : std::nullopt;
  }

 private:
  Params params_;
};

/// Reaches controllers, draws, measures, and begins the run anew.
class Teacher final : public core::Hook {
 public:
  struct Params {
    std::int64_t reset_at = -1, resets = 1;
    bool keeps = true, at_once = false;
    double pace = 1.0;
    void describe(hal::ParamVisitor& v) {
      v.integer("reset_at", reset_at, hal::kAny, "Begins the run anew after this tick, with the next seed.");
      v.integer("resets", resets, hal::kAny, "How often.");
      v.flag("keeps", keeps, "It remembers how often it did.");
      v.flag("at_once", at_once, "It asks for a reset before the run.");
      v.number("pace", pace, hal::unit::none, hal::kAny, "What it tells the controllers.");
    }
  };
  explicit Teacher(const Params& params) : params_(params) {}

  void before_run(core::HookContext& c) override {
    if (params_.at_once) c.checkpoints.reset(1);
  }
  void after_step(core::HookContext& c) override {
    for (std::size_t i = 0; i < c.space.robot_count(); ++i) {
      const core::RobotId robot = c.space.robot(i);
      if (auto* shown = c.controller<test::Shown>(robot)) shown->pace = params_.pace;
      const core::Pose pose = c.space.pose(robot);
      c.sketch.circle({pose.x_m, pose.y_m}, 0.1);
      c.sketch.text({pose.x_m, pose.y_m}, "<" + c.space.published_text(robot, "mode").value() + ">");
    }
    c.measures.add("steps");
    c.measures.set("tick", static_cast<double>(c.tick));
    if (c.tick != params_.reset_at || done_ == params_.resets) return;
    ++done_;
    c.checkpoints.reset(c.seed + 1);
  }
  bool reset(std::uint64_t) override { return params_.keeps; }
  std::any save() const override { return 0; }

 private:
  Params params_;
  std::int64_t done_ = 0;
};

/// Has one control of each kind, keeps nothing by itself, and puts boxes into the arena with the values as they are.
class Knobs final : public core::Hook {
 public:
  struct Params {
    void describe(hal::ParamVisitor&) {}
  };
  explicit Knobs(const Params&) {}

  void controls(core::HookContext& context, hal::Controls& c) override {
    static constexpr std::array<std::string_view, 2> kShapes{"box", "cylinder"};
    c.number("size", size_m_, hal::unit::cm, {0.02, 0.2}, "Of what is put down.");
    c.integer("count", count_, {1, 5}, "How many at once.");
    c.flag("movable", movable_, "They can be pushed.");
    c.choice("shape", shape_, kShapes, "Of what is put down.");
    if (c.text("prefix", prefix_, "Of their ids.") && prefix_ == "bad") throw std::runtime_error("a bad prefix");
    if (c.button("drop", "Puts them down.")) drop(context);
  }
  void after_step(core::HookContext& c) override {
    c.measures.set("size", size_m_);
    c.measures.set("count", static_cast<double>(count_));
  }

 private:
  void drop(core::HookContext& c) {
    for (std::int64_t i = 0; i < count_; ++i) {
      core::Object object;
      object.kind = shape_ == "box" ? core::Object::Kind::Box : core::Object::Kind::Cylinder;
      object.id = prefix_ + std::to_string(c.space.objects().size());
      object.x_m = 0.25 * static_cast<double>(c.space.objects().size() % 5);
      object.y_m = 1.2;
      object.half_x_m = object.half_y_m = object.radius_m = 0.5 * size_m_;
      object.z_high_m = 0.1;
      object.movable = movable_;
      (void)c.space.add_object(object);
    }
  }
  double size_m_ = 0.1;
  std::int64_t count_ = 1;
  bool movable_ = false;
  std::string shape_ = "box", prefix_ = "dropped";
};

/// Turns a robot by how often it was called, which it does not save.
class Forgetful final : public core::Hook {
 public:
  struct Params {
    void describe(hal::ParamVisitor&) {}
  };
  explicit Forgetful(const Params&) {}
  void before_step(core::HookContext& c) override {
    const core::Pose pose = c.space.pose(c.space.robot(0));
    c.space.set_pose(c.space.robot(0), core::Pose::at(pose.x_m, pose.y_m, 0.01 * ++calls_, pose.z_m));
  }

 private:
  int calls_ = 0;
};

void register_all(hal::Registrar& registrar) {
  registrar.add(core::hook_type<Teacher>("teacher", "Knows controllers by their class."));
  registrar.add(core::hook_type<Painter>("painter", "Paints a disc."));
  registrar.add(core::hook_type<Shepherd>("shepherd", "Robots and boxes come and go."));
  registrar.add(core::hook_type<Forgetful>("forgetful", "Does not save what it depends on."));
  registrar.add(core::hook_type<Knobs>("knobs", "One control of each kind."));
  registrar.add(core::hook_type<Dial>("dial", "Paints a floor of one shade."));
  registrar.add(core::hook_type<Diary>("diary", "Writes its calls down."));
}

}  // namespace

TANDEM_PLUGIN(register_all)
