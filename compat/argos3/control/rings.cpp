// Sensors in rings, and those of the robot's own state.
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_battery_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_ground_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_light_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_proximity_sensor.h>
#include <argos3/plugins/robots/eye-bot/control_interface/ci_eyebot_light_sensor.h>
#include <argos3/plugins/robots/eye-bot/control_interface/ci_eyebot_proximity_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_base_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_light_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_motor_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_battery_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_ground_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_light_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_proximity_sensor.h>
#include <array>

#include "compat/argos3/control/device.hpp"
#include "hal/device/argos_curves.hpp"
#include "hal/device/argos_readings.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::compat::argos3 {
namespace {

namespace units = hal::argos;

argos::Real& value_of(argos::Real& reading) noexcept {
  return reading;
}
argos::Real& value_of(argos::tandem_detail::SRingReading& reading) noexcept {
  return reading.Value;
}

/// Makes a reading a sensor, in ARGoS' order. `order`: our number of each.
template <class Readings>
void fit_ring(Readings& readings, std::vector<std::size_t>& order, std::span<const hal::Mount> mounts) {
  order = units::counter_clockwise(mounts);
  readings.assign(order.size(), {});
  if constexpr (requires { readings[0].Angle; }) {
    for (std::size_t i = 0; i < order.size(); ++i)
      readings[i].Angle = argos::CRadians(units::signed_angle(mounts[order[i]].bearing_rad));
  }
}

template <class Cci>
class ProximityOf final : public SensorOn<Cci, hal::Proximity> {
 public:
  void sense() override {
    const hal::Proximity& p = this->port();
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const std::size_t own = order_[i];
      const bool nothing = own >= p.count || p.distance_m[own] == p.range_m;  // farther: a reading that is noise alone
      value_of(this->m_tReadings[i]) =
          nothing ? 0.0 : hal::argos_reading(curve_, static_cast<double>(p.distance_m[own]));
    }
  }

 private:
  void fit(const Fitting& fitting) override {
    curve_ = hal::argos_proximity(fitting.written);
    if (const auto* const part = fitting.kind.part<hal::ProximityPart>())
      fit_ring(this->m_tReadings, order_, part->mounts);
  }
  std::vector<std::size_t> order_;
  hal::ArgosProximity curve_ = hal::ArgosProximity::Footbot;
};

template <class Cci>
class LightOf final : public SensorOn<Cci, hal::Light> {
 public:
  void sense() override {
    const hal::Light& light = this->port();
    for (std::size_t i = 0; i < order_.size(); ++i)
      value_of(this->m_tReadings[i]) = order_[i] < light.count ? static_cast<double>(light.level[order_[i]]) : 0.0;
  }

 private:
  void fit(const Fitting& fitting) override {
    if (const auto* const part = fitting.kind.part<hal::LightPart>()) fit_ring(this->m_tReadings, order_, part->mounts);
  }
  std::vector<std::size_t> order_;
};

class PlainGround final : public SensorOn<argos::CCI_GroundSensor, hal::Ground> {
 public:
  void sense() override { m_tReadings.assign(port().reflectance.begin(), port().reflectance.begin() + port().count); }
};

template <class Cci, class Port, class Part>
class GroundOf final : public SensorOn<Cci, Port> {
 public:
  void sense() override {
    for (std::size_t i = 0; i < this->m_tReadings.size(); ++i)
      this->m_tReadings[i].Value = static_cast<double>(this->port().reflectance[i]);
  }

 private:
  void fit(const Fitting& fitting) override {
    const Part* const part = fitting.kind.part<Part>();
    this->m_tReadings.clear();
    for (std::size_t i = 0; part != nullptr && i < part->mounts.size(); ++i) {
      const hal::Mount& m = part->mounts[i];
      this->m_tReadings.push_back({0.0, argos::CVector2(m.x_m / units::kM_per_cm, m.y_m / units::kM_per_cm)});
    }
  }
};

/// Ours counts from the right; ARGoS' is named.
class EpuckGround final : public SensorOn<argos::CCI_EPuckGroundSensor, hal::Ground> {
 public:
  void sense() override {
    for (std::size_t i = 0; i < 3; ++i) m_sReadings[2 - i] = static_cast<double>(port().reflectance[i]);
  }
};

class PositioningOf final : public SensorOn<argos::CCI_PositioningSensor, hal::Positioning> {
 public:
  void sense() override {
    const auto& [w, x, y, z] = port().q_WB;
    m_sReading.Position.Set(port().p_WB[0], port().p_WB[1], port().p_WB[2]);
    m_sReading.Orientation.Set(w, x, y, z);
  }
};

class BatteryOf final : public SensorOn<argos::CCI_BatterySensor, hal::Battery> {
 public:
  void sense() override { m_sReading.AvailableCharge = static_cast<double>(port().charge); }
};

class EpuckBattery final : public SensorOn<argos::CCI_EPuckBatterySensor, hal::Battery> {
 public:
  void sense() override { m_fBatteryLevel = static_cast<double>(port().charge); }
};

}  // namespace

std::span<const DeviceClass> ring_classes() {
  using namespace argos;
  using BaseGround = GroundOf<CCI_FootBotBaseGroundSensor, hal::BaseGround, hal::BaseGroundPart>;
  using MotorGround = GroundOf<CCI_FootBotMotorGroundSensor, hal::MotorGround, hal::MotorGroundPart>;
  static const std::array all = {device_class<ProximityOf<CCI_ProximitySensor>>("proximity"),
                                 device_class<ProximityOf<CCI_FootBotProximitySensor>>("footbot_proximity"),
                                 device_class<ProximityOf<CCI_EPuckProximitySensor>>("epuck_proximity"),
                                 device_class<ProximityOf<CCI_EyeBotProximitySensor>>("eyebot_proximity"),
                                 device_class<LightOf<CCI_LightSensor>>("light"),
                                 device_class<LightOf<CCI_FootBotLightSensor>>("footbot_light"),
                                 device_class<LightOf<CCI_EPuckLightSensor>>("epuck_light"),
                                 device_class<LightOf<CCI_EyeBotLightSensor>>("eyebot_light"),
                                 device_class<PlainGround>("ground"),
                                 device_class<EpuckGround>("epuck_ground"),
                                 device_class<BaseGround>("footbot_base_ground"),
                                 device_class<MotorGround>("footbot_motor_ground"),
                                 device_class<PositioningOf>("positioning"),
                                 device_class<BatteryOf>("battery"),
                                 device_class<EpuckBattery>("epuck_battery")};
  return all;
}

}  // namespace tandem::compat::argos3
