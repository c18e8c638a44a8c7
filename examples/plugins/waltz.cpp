// A controller: straight on, then round, and again.
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

class Waltz final : public hal::Controller {
 public:
  struct Params {
    double speed_m_s = 0.05;
    std::int64_t beat = 10;
    void describe(hal::ParamVisitor& v) {
      v.number("speed", speed_m_s, hal::unit::m_s, {0.0, 1.0}, "Of the robot, straight on.");
      v.integer("beat", beat, {1, 10000}, "Steps straight on, and steps round.");
    }
  };
  Waltz(hal::Robot& robot, const Params& params) : wheels_(robot.actuator<hal::WheelSpeeds>()), params_(params) {}

  void step() override {
    const bool straight = step_++ / params_.beat % 2 == 0;
    wheels_.set(params_.speed_m_s, straight ? params_.speed_m_s : -params_.speed_m_s);
  }

 private:
  hal::WheelSpeeds& wheels_;
  Params params_;
  std::int64_t step_ = 0;
};

void register_all(hal::Registrar& registrar) {
  registrar.add_controller<Waltz>("waltz", "Straight on, then round, and again.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
