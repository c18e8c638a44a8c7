#include "bridges/eyebot_emulator/register.hpp"

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/eyebot_emulator/body.hpp"
#include "bridges/eyebot_emulator/emulator.hpp"
#include "bridges/eyebot_emulator/faults.hpp"
#include "hal/device/flight.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

struct Own {
  std::string name = "eb0", clock = "synced";
  std::int64_t count = 1;
  double images_hz = 0.0;
  Delays delays{};
  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kClocks = {"synced", "unsynced"};
    v.text("name", name, "Its name, or that of the first.");
    v.integer("count", count, {}, "How many: eb0, eb1, ….");
    v.choice("clock", clock, kClocks, "synced: it refuses commands whose stamps are 250 ms off its clock.");
    v.number("images", images_hz, hal::unit::hz, {0.0, 2.0}, "Images that it sends a second.");
    v.number("body_delay", delays.body_s, hal::unit::s, {0.0, 2.0}, "By which its body is later than its motors.");
    delays.describe(v);
  }
};

hal::Status run_type(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  Options options;
  apply(request, options);
  const Own own = request.options == nullptr ? Own{} : *static_cast<const Own*>(request.options.get());
  options.robot.name = own.name;
  options.robot.clock_synced = own.clock == "synced";
  options.robot.image_hz = own.images_hz;
  options.robot.delays = own.delays;
  options.count = static_cast<int>(std::clamp<std::int64_t>(own.count, -1, 1'000'000));
  options.ready = [&request, &own](const std::string& url) {
    const std::string who = own.count > 1 ? std::to_string(own.count) + " eye-bots" : "eye-bot " + own.name;
    if (request.ready) request.ready(who + " on " + url + ": connect with --link lcm:" + url);
  };
  std::optional<PortBody> body;
  if (ports != nullptr) options.body = &body.emplace(*ports);
  return run(options, stop);
}

const EmulatorType kType{
    .name = "eyebot",
    .kind = hal::eyebot::kName,
    .summary = "Eye-bots on a network: lcm:udpm://GROUP:PORT?ttl=0.",
    .puppet = "<eyebot_puppet library=\"puppet\" …> with flight_task, quadrotor_speed, flight_state and positioning",
    .needs = &port_types_of<hal::FlightTask, hal::QuadrotorSpeed, hal::FlightState, hal::Positioning>,
    .ports = &body_ports,
    .faults = [] { return kFaults.manual(); },
    .read = &read_options<Own>,
    .run = &run_type};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::eyebot_emulator
