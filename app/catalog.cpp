#include "app/catalog.hpp"

#include "bridges/epuck/register.hpp"
#include "bridges/epuck_emulator/register.hpp"
#include "bridges/eyebot/register.hpp"
#include "bridges/eyebot_emulator/register.hpp"
#include "bridges/footbot/register.hpp"
#include "bridges/footbot_emulator/register.hpp"
#include "bridges/tag_tracker/register.hpp"
#include "bridges/thymio/register.hpp"
#include "bridges/thymio_emulator/register.hpp"
#include "bridges/tracker_emulator/register.hpp"
#include "bridges/tracker_type.hpp"
#include "bridges/trackers/register.hpp"
#include "bridges/wired/register.hpp"
#include "core/device/device.hpp"
#include "core/field/floor/floor.hpp"
#include "core/field/light/light.hpp"
#include "core/field/sound/sound.hpp"
#include "core/hook/hook.hpp"
#include "core/medium/led/led.hpp"
#include "core/medium/medium.hpp"
#include "core/medium/range_and_bearing/range_and_bearing.hpp"
#include "core/physics/dynamics2d/dynamics2d.hpp"
#include "core/physics/dynamics3d/dynamics3d.hpp"
#include "core/physics/kinematics2d/kinematics2d.hpp"
#include "core/physics/particle3d/particle3d.hpp"
#include "core/run/run.hpp"
#include "core/scenario/observer_type.hpp"
#include "core/scenario/run_part_type.hpp"
#include "core/space/stores.hpp"
#include "core/view/layers/layers.hpp"
#include "hal/check.hpp"
#include "hal/command.hpp"
#include "hal/device/ports.hpp"
#include "hal/robot/robots.hpp"
#include "mixed_reality/record_tracker/record_tracker.hpp"

namespace tandem::app {

const hal::Catalog& catalog() {
  static const hal::Catalog all = [] {
    hal::Catalog made;
    made.know<hal::CommandType>();
    made.know<core::HookType>();
    made.know<core::ObserverType>();
    made.know<core::RunPartType>();
    made.know<core::RunSurface>();
    made.know<core::StoresSurface>();
    made.know<bridges::TrackerType>();
    const hal::Status good = made.add_from(std::string(hal::Catalog::kInside), [](hal::Registrar& r) {
      hal::register_ports(r);
      hal::register_robots(r);
      core::register_floor(r);
      core::register_light(r);
      core::register_sound(r);
      core::register_led_medium(r);
      core::register_range_and_bearing_medium(r);
      core::register_unused_media(r);
      core::register_devices(r);
      core::register_kinematics2d(r);
      core::register_dynamics2d(r);
      core::register_dynamics3d(r);
      core::register_particle3d(r);
      core::register_layers(r);
      bridges::epuck::register_bridge(r);
      bridges::footbot::register_bridge(r);
      bridges::eyebot::register_bridge(r);
      bridges::thymio::register_bridge(r);
      bridges::epuck_emulator::register_emulator(r);
      bridges::footbot_emulator::register_emulator(r);
      bridges::eyebot_emulator::register_emulator(r);
      bridges::thymio_emulator::register_emulator(r);
      bridges::wired::register_wired_robots(r);
      bridges::trackers::register_trackers(r);
      bridges::tag_tracker::register_tracker(r);
      mixed_reality::register_record_tracker(r);
      bridges::tracker_emulator::register_emulator(r);
    });
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

}  // namespace tandem::app
