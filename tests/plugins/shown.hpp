// A controller that uses all that a robot offers beside its devices, and that a hook knows by its class.
#pragma once
#include <memory>
#include <string>

#include "hal/controller.hpp"
#include "hal/device/wheels.hpp"
#include "hal/random.hpp"

namespace tandem::test {

/// Drives with speeds by chance. Publishes its mode, its steps and what it drew.
class Shown final : public hal::Controller {
 public:
  enum class Mode : std::uint8_t { Rest, Drive };
  struct Params {
    std::string wrong;
    bool learns = false;
    bool talks = false;
    void describe(hal::ParamVisitor& v) {
      v.text("wrong", wrong, "What it publishes that it must not: elsewhere or twice.");
      v.flag("learns", learns, "It is kept when the run begins anew.");
      v.flag("talks", talks, "It says something in every step.");
    }
  };

  Shown(hal::Robot& robot, const Params& params)
      : wheels_(robot.actuator<hal::WheelSpeeds>()), params_(params), random_(robot.random()), log_(robot.log()) {
    robot.publish("mode", mode_, {"rest", "drive"}, "What it does.");
    robot.publish("steps", steps_);
    robot.publish("drawn", drawn_, hal::unit::m_s, "The last speed.");
    if (params.wrong == "elsewhere") robot.publish("far", *elsewhere_);
    if (params.wrong == "twice") robot.publish("steps", runs);
    log_.info("made");
  }

  void step() override {
    ++steps_;
    mode_ = steps_ % 4 == 0 ? Mode::Rest : Mode::Drive;
    drawn_ = pace * random_.uniform(0.0, 0.08);
    wheels_.set(drawn_, mode_ == Mode::Rest ? 0.0 : 0.5 * drawn_);
    if (params_.talks) log_.warning("step " + std::to_string(steps_));
  }

  bool reset(hal::Robot& robot) override {
    if (!params_.learns) return false;
    ++runs;
    mode_ = Mode::Rest;
    steps_ = 0;
    drawn_ = 0.0;
    random_ = robot.random();
    log_ = robot.log();
    pace = 1.0;
    return true;
  }

  void controls(hal::Controls& c) override {
    c.number("pace", pace, hal::unit::percent, {0.0, 2.0}, "Of the speeds that it draws.");
    if (c.button("rest", "Rests in the next step.")) steps_ = 3;
  }

  double pace = 1.0;      ///< for hooks
  std::int32_t runs = 1;  ///< that this object has seen

 private:
  hal::WheelSpeeds& wheels_;
  Params params_;
  hal::Random random_;
  hal::RobotLog log_;
  Mode mode_ = Mode::Rest;
  std::int32_t steps_ = 0;
  double drawn_ = 0.0;
  std::shared_ptr<double> elsewhere_ = std::make_shared<double>(0.0);
};

}  // namespace tandem::test
