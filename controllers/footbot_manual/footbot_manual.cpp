#include "controllers/footbot_manual/footbot_manual.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::controllers {
namespace {

constexpr int kMostInATick = 64;  // datagrams; a flood of them must not hold the run up

template <class Port>
Port* where_listed(hal::Robot& robot) {
  try {
    return &robot.actuator<Port>();
  } catch (const hal::DeviceError&) {
    return nullptr;
  }
}

}  // namespace

FootbotManual::FootbotManual(hal::Robot& robot, const Params& params)
    : clock_(robot.sensor<hal::Clock>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      turret_(where_listed<hal::TurretDrive>(robot)),
      gripper_(where_listed<hal::GripperDrive>(robot)),
      wheel_base_m_(robot.part<hal::DifferentialDrive>().wheel_base_m),
      fastest_m_s_(robot.part<hal::DifferentialDrive>().max_speed_m_s),
      silence_ns_(static_cast<hal::TimeNs>(params.silence_s * 1e9)),
      heard_ns_(-silence_ns_),
      datagrams_(std::make_shared<Datagrams>(params.address, static_cast<std::uint16_t>(params.port))) {
  const std::string way =
      (params.address == "0.0.0.0" ? "127.0.0.1" : params.address) + "/" + std::to_string(params.port);
  robot.log().info(
      "waits for orders; while it is to drive, again and again: echo \"drive 10 cm/s 0.5 rad/s\" > /dev/udp/" + way);
}

void FootbotManual::step() {
  std::string_view text;
  for (int i = 0; i < kMostInATick && datagrams_->receive(text); ++i) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      obey(text.substr(at, end - at));
      at = end + 1;
    }
  }
  if (clock_.now_ns - heard_ns_ < silence_ns_) return;
  wheels_.set(0.0, 0.0);
  if (turret_ != nullptr && turret_->mode == hal::TurretMode::Speed) turret_->turn_off();
}

void FootbotManual::obey(std::string_view line) {
  if (line.starts_with("error:")) return;  // two robots that answered each other's answers would never end
  const auto order = parse_order(line);
  const hal::Status done = order.ok() ? carry_out(order.value()) : hal::Status(order.error());
  if (done.ok())
    heard_ns_ = clock_.now_ns;
  else
    datagrams_->reply("error: " + done.error().message + "\n");
}

hal::Status FootbotManual::carry_out(const Order& order) {
  if (const auto* way = std::get_if<Drive>(&order)) {
    drive(*way);
    return {};
  }
  if (const auto* grip = std::get_if<Grip>(&order)) {
    if (gripper_ == nullptr) return hal::Error{"no gripper: list it among the actuators of the configuration"};
    grip->holds ? gripper_->lock() : gripper_->unlock();
    return {};
  }
  return turn_turret(order);
}

/// Beyond what the wheels can do it is slower, along the same arc.
void FootbotManual::drive(const Drive& order) noexcept {
  const double rim_m_s = 0.5 * wheel_base_m_ * order.turn_rad_s;
  const double most_m_s = std::fabs(order.ahead_m_s) + std::fabs(rim_m_s);
  const double part = most_m_s > fastest_m_s_ ? fastest_m_s_ / most_m_s : 1.0;
  wheels_.set(part * (order.ahead_m_s - rim_m_s), part * (order.ahead_m_s + rim_m_s));
}

hal::Status FootbotManual::turn_turret(const Order& order) noexcept {
  if (turret_ == nullptr) return hal::Error{"no turret: list it among the actuators of the configuration"};
  if (const auto* to = std::get_if<TurretTo>(&order))
    turret_->go_to(to->angle_rad);
  else if (const auto* turn = std::get_if<TurretTurn>(&order))
    turret_->turn(turn->speed_rad_s);
  else if (std::get<TurretFree>(order).passive)
    turret_->let_go();
  else
    turret_->turn_off();
  return {};
}

}  // namespace tandem::controllers
