// Translates the commands of a flying robot's controller into setpoints of its engine.
#include <algorithm>
#include <cmath>

#include "core/device/altitude.hpp"
#include "core/device/coupling.hpp"
#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"

namespace tandem::core {
namespace {

using hal::FlightOrder;
using hal::FlightPhase;
using Mode = FlightCommand::Mode;

constexpr double kStands_m = 0.01;          // with so little room beneath it stands
constexpr double kSinks_m_s = 0.02;         // what sinks more slowly though it is to has come to stand
constexpr double kStuck_s = 1.0;            // … for so long: longer than it takes to stop a climb
constexpr double kArrived_m = 0.02;         // from the height to which it takes off
constexpr double kHangs_m = 0.02;           // with so little room above the magnet holds
constexpr double kLetGo_m = 0.3;            // so far it sinks from the ceiling
constexpr double kClearOfCeiling_m = 0.05;  // that taking off leaves above the robot
constexpr double kSlowDown_1_s = 2.0;       // climbing speed for each metre that is left

/// One robot of the block.
class Pilot {
 public:
  Pilot(const DeviceContext& context, SpaceStores& stores, std::size_t slot, const FlightSetpoint& setpoint,
        PilotState& state, FlightCommand& command)
      : stores_(stores),
        body_(context.group.kind->body),
        flight_(*context.group.kind->flight()),
        row_(context.block.first_row + slot),
        tick_s_(context.tick_s),
        obeys_(obeys(context, slot)),
        setpoint_(setpoint),
        state_(state),
        command_(command) {}

  void fly() noexcept {
    if (!obeys_) return hover_by_speed();
    if (setpoint_.attitude.active) {
      const hal::QuadrotorAttitude& a = setpoint_.attitude;
      command_ = {Mode::Attitude, {a.roll_rad, a.pitch_rad, a.thrust}, a.yaw_rad_s};
      state_.phase = FlightPhase::Flying;
    } else if (setpoint_.to_place) {
      command_ = {Mode::Position, setpoint_.target_m, setpoint_.heading_rad};
      state_.phase = FlightPhase::Flying;
    } else {
      command_ = {Mode::Velocity, setpoint_.velocity_m_s, setpoint_.turn_rad_s};
      const std::array<double, 3>& v = setpoint_.velocity_m_s;
      const bool rests = v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0 && setpoint_.turn_rad_s == 0.0;
      state_.phase = rests ? FlightPhase::Hovering : FlightPhase::Flying;
    }
  }

  void carry_out_task() noexcept {
    if (!state_.started) start();
    const FlightOrder order = obeys_ ? setpoint_.task.order : FlightOrder::Fly;
    if (order != state_.order) begin(order);
    state_.order = order;
    switch (state_.phase) {
      case FlightPhase::Off:
      case FlightPhase::Stopped:
      case FlightPhase::Landed:
        command_ = {Mode::None, {}, 0.0};
        return;
      case FlightPhase::TakingOff:
        return rise_to_place();
      case FlightPhase::Landing:
        return land();
      case FlightPhase::Attaching:
        return attach();
      case FlightPhase::Attached:
        command_ = {Mode::Held, {}, 0.0};
        return;
      case FlightPhase::Detaching:
        return let_go();
      case FlightPhase::Hovering:
      case FlightPhase::Flying:
        return order == FlightOrder::Fly ? fly() : hover();
    }
  }

 private:
  const Bodies& bodies() const noexcept { return stores_.bodies; }
  double base_m() const noexcept { return stores_.base_m(row_); }
  double speed_or(double own_m_s) const noexcept {
    return setpoint_.task.speed_m_s > 0.0 ? setpoint_.task.speed_m_s : own_m_s;
  }
  bool in_the_air() const noexcept {
    return state_.phase == FlightPhase::Hovering || state_.phase == FlightPhase::Flying ||
           state_.phase == FlightPhase::TakingOff || state_.phase == FlightPhase::Landing ||
           state_.phase == FlightPhase::Attaching || state_.phase == FlightPhase::Detaching;
  }

  void start() noexcept {
    state_.started = true;
    const bool stands = room_below_m(stores_, row_, false) <= kStands_m;
    state_.phase = stands ? FlightPhase::Landed : FlightPhase::Hovering;
    note_place();
  }
  void note_place() noexcept {
    state_.place_m = {bodies().x_m[row_], bodies().y_m[row_], base_m()};
    state_.heading_rad = std::atan2(bodies().sin_h[row_], bodies().cos_h[row_]);
  }

  /// A new order. What does not fit where the robot is changes nothing: nobody lands from the ceiling, lets go of the
  /// ground, or holds on to a ceiling that is not there.
  void begin(FlightOrder order) noexcept {
    state_.stuck_ticks = 0;
    if (order == FlightOrder::TakeOff && state_.phase == FlightPhase::Landed) {
      note_place();
      const double most_m = ceiling_m(stores_, row_) - body_.height_m - kClearOfCeiling_m;
      state_.place_m[2] = std::max(base_m(), std::min(base_m() + flight_.take_off_m, most_m));
      state_.phase = FlightPhase::TakingOff;
      return;
    }
    if (order == FlightOrder::Detach && state_.phase == FlightPhase::Attached) {
      note_place();
      state_.place_m[2] = std::max(0.0, base_m() - kLetGo_m);
      state_.phase = FlightPhase::Detaching;
      return;
    }
    if (!in_the_air()) return;
    if (order == FlightOrder::Land) {
      state_.phase = FlightPhase::Landing;
    } else if (order == FlightOrder::Attach && std::isfinite(ceiling_m(stores_, row_))) {
      state_.phase = FlightPhase::Attaching;
    } else {
      note_place();
      state_.phase = FlightPhase::Hovering;
    }
  }

  void hover_by_speed() noexcept {
    command_ = {Mode::Velocity, {}, 0.0};
    state_.phase = FlightPhase::Hovering;
  }
  void hover() noexcept {
    command_ = {Mode::Position, state_.place_m, state_.heading_rad};
    state_.phase = FlightPhase::Hovering;
  }
  void rise_to_place() noexcept {
    const double left_m = state_.place_m[2] - base_m();
    if (left_m <= kArrived_m) return hover();
    command_ = {Mode::Velocity, {0.0, 0.0, std::min(speed_or(flight_.climb_m_s), 0.1 + kSlowDown_1_s * left_m)}, 0.0};
  }
  void land() noexcept {
    const double sink_m_s = speed_or(flight_.sink_m_s);
    command_ = {Mode::Velocity, {0.0, 0.0, -sink_m_s}, 0.0};
    const bool slow = bodies().motion[row_].v_m_s[2] > -std::min(kSinks_m_s, 0.5 * sink_m_s);
    state_.stuck_ticks = slow ? state_.stuck_ticks + 1 : 0;
    if (room_below_m(stores_, row_, true) > kStands_m && state_.stuck_ticks * tick_s_ < kStuck_s) return;
    command_ = {Mode::None, {}, 0.0};
    state_.phase = FlightPhase::Landed;
  }
  void attach() noexcept {
    command_ = {Mode::Velocity, {0.0, 0.0, speed_or(flight_.climb_m_s)}, 0.0};
    if (ceiling_m(stores_, row_) - base_m() - body_.height_m > kHangs_m) return;
    command_ = {Mode::Held, {}, 0.0};
    state_.phase = FlightPhase::Attached;
    Motion& m = stores_.bodies.motion[row_];
    m.v_m_s = m.w_rad_s = {};
    m.q_WB = {std::cos(0.5 * heading_rad()), 0.0, 0.0, std::sin(0.5 * heading_rad())};
  }
  void let_go() noexcept {
    if (base_m() <= state_.place_m[2] + kArrived_m) return hover();
    command_ = {Mode::Velocity, {0.0, 0.0, -speed_or(flight_.sink_m_s)}, 0.0};
  }
  double heading_rad() const noexcept { return std::atan2(bodies().sin_h[row_], bodies().cos_h[row_]); }

  SpaceStores& stores_;
  const hal::Body& body_;
  const hal::Quadrotor& flight_;
  std::size_t row_;
  double tick_s_;
  bool obeys_;
  const FlightSetpoint& setpoint_;
  PilotState& state_;
  FlightCommand& command_;
};

/// Goes through flying robots once all their actuators have acted: which of their commands counts, and how far tasks
/// (taking off, landing, holding on to the ceiling) have come.
///
/// A robot whose controller takes FlightTask starts landed where it stands on something, else in the air; others obey
/// their commands from the start. One that is halted hovers, or stays where it stands or hangs.
class Piloting final : public Coupling {
 public:
  explicit Piloting(Columns& columns)
      : setpoints_(columns.of<FlightSetpoint>()),
        pilots_(columns.of<PilotState>()),
        commands_(columns.of<FlightCommand>()) {}

  void drive(const DeviceContext& context, SpaceStores& stores) noexcept override {
    if (setpoints_.empty()) return;
    const auto b = static_cast<std::size_t>(&context.block - stores.blocks.data());
    const FlightSetpoint* const setpoints = setpoints_.of_block(b);
    if (setpoints == nullptr) return;
    PilotState* const states = pilots_.of_block(b);
    FlightCommand* const commands = commands_.of_block(b);
    const bool tasks = context.group.takes<hal::FlightTask>();
    for (std::size_t i = 0; i < context.block.used; ++i) {
      Pilot robot(context, stores, i, setpoints[i], states[i], commands[i]);
      if (tasks && !led_from_outside(context, i))
        robot.carry_out_task();
      else
        robot.fly();
    }
  }

 private:
  Column<FlightSetpoint> setpoints_;
  Column<PilotState> pilots_;
  Column<FlightCommand> commands_;
};

}  // namespace

CouplingType piloting_type() {
  return {"piloting", "Carries out flight tasks, and chooses among the commands of flight devices.",
          [](Columns& columns) -> std::unique_ptr<Coupling> { return std::make_unique<Piloting>(columns); }};
}

}  // namespace tandem::core
