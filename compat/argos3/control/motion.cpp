// Wheels, turret, gripper, scanner, flight: units of ARGoS to ours.
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_encoder_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_wheels_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_encoder_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_gripper_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_encoder_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_gripper_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_pan_tilt_camera_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_quadrotor_position_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_quadrotor_speed_actuator.h>
#include <array>
#include <numbers>

#include "compat/argos3/control/device.hpp"
#include "hal/device/argos_readings.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace argos {

const Real CCI_EPuckWheelsActuator::MAX_VELOCITY_CM_SEC = 12.8;
const Real CCI_EPuckWheelsActuator::MIN_VELOCITY_CM_SEC = -12.8;
const Real CCI_EPuckEncoderSensor::WHEEL_AXIS_LENGTH = 5.3;
CRadians CCI_FootBotGripperActuator::UNLOCKED(0.0);
CRadians CCI_FootBotGripperActuator::LOCKED_POSITIVE(0.5 * ARGOS_PI);
CRadians CCI_FootBotGripperActuator::LOCKED_NEGATIVE(-0.5 * ARGOS_PI);
const CRange<SInt32> CCI_FootBotTurretActuator::SPEED_RANGE(-4, 4);
const CRange<Real> CCI_FootBotTurretActuator::NORMALIZED_SPEED_RANGE(-1.0, 1.0);
const CRange<CRadians> CCI_FootBotTurretEncoderSensor::ANGULAR_RANGE(CRadians(-ARGOS_PI), CRadians(ARGOS_PI));

}  // namespace argos

namespace tandem::compat::argos3 {
namespace {

using argos::CRadians, argos::CVector3, argos::Real;
using hal::argos::kM_per_cm;

constexpr double kRad_s_per_rpm = 2.0 * std::numbers::pi / 60.0;

template <class Cci>
class WheelsOf final : public ActuatorOn<Cci, hal::WheelSpeeds> {
 public:
  void SetLinearVelocity(Real left, Real right) override { this->port().set(left * kM_per_cm, right * kM_per_cm); }
};

template <class Cci>
class EncodersOf final : public SensorOn<Cci, hal::WheelEncoders> {
 public:
  EncodersOf() { this->used = true; }  // it compares with the tick before
  void begin() override { left_m_ = right_m_ = 0.0; }
  void sense() override {
    const hal::WheelEncoders& encoders = this->port();
    auto& reading = this->m_sReading;
    reading.CoveredDistanceLeftWheel = (encoders.left_m - left_m_) / kM_per_cm;
    reading.CoveredDistanceRightWheel = (encoders.right_m - right_m_) / kM_per_cm;
    if constexpr (requires { reading.VelocityLeftWheel; }) {
      reading.VelocityLeftWheel = static_cast<double>(encoders.left_m_s) / kM_per_cm;
      reading.VelocityRightWheel = static_cast<double>(encoders.right_m_s) / kM_per_cm;
    }
    left_m_ = encoders.left_m;
    right_m_ = encoders.right_m;
  }

 private:
  void fit(const Fitting& fitting) override {
    const hal::DifferentialDrive* const drive = fitting.kind.drive();
    if constexpr (requires { this->m_sReading.WheelAxisLength; })
      this->m_sReading.WheelAxisLength = drive == nullptr ? 0.0 : drive->wheel_base_m / kM_per_cm;
  }
  double left_m_ = 0.0, right_m_ = 0.0;  // at the step before
};

class TurretOf final : public ActuatorOn<argos::CCI_FootBotTurretActuator, hal::TurretDrive> {
 public:
  void SetRotation(const CRadians& angle) override { port().angle_rad = angle.GetValue(); }
  void SetRotationSpeed(argos::SInt32 rpm) override { port().speed_rad_s = rpm * kRad_s_per_rpm; }
  void SetMode(ETurretModes mode) override {
    constexpr std::array kModes = {hal::TurretMode::Off, hal::TurretMode::Passive, hal::TurretMode::Speed,
                                   hal::TurretMode::Position};
    port().mode = kModes.at(static_cast<std::size_t>(mode));
  }
};

class TurretAngle final : public SensorOn<argos::CCI_FootBotTurretEncoderSensor, hal::TurretEncoder> {
 public:
  void sense() override { m_cRotation.SetValue(port().angle_rad); }
};

class FootbotGripper final : public ActuatorOn<argos::CCI_FootBotGripperActuator, hal::GripperDrive> {
 public:
  void SetAperture(const CRadians& aperture) override {
    const double rad = CRadians(aperture).SignedNormalize().GetValue();
    port().aperture_rad = std::clamp(rad, -hal::GripperDrive::kMost_rad, hal::GripperDrive::kMost_rad);
  }
  void EnableCheckForObjectGrippedRoutine() override {}
  void DisableCheckForObjectGrippedRoutine() override {}
};

class PlainGripper final : public ActuatorOn<argos::CCI_GripperActuator, hal::GripperDrive> {
 public:
  void SetLockState(Real state) override {
    port().aperture_rad = std::clamp(state, 0.0, 1.0) * hal::GripperDrive::kMost_rad;
  }
  void Lock() override { port().lock(); }
  void Unlock() override { port().unlock(); }
};

class ScannerMotor final : public ActuatorOn<argos::CCI_FootBotDistanceScannerActuator, hal::ScannerDrive> {
 public:
  void reset() override { port() = last_; }
  void SetAngle(const CRadians& angle) override {
    port().go_to(angle.GetValue());
    last_ = port();
  }
  void SetRPM(Real rpm) override {
    port().turn(rpm * kRad_s_per_rpm);
    last_ = port();
  }
  void Enable() override {
    if (port().mode == hal::ScannerMode::Off) port().go_to(port().angle_rad);
    last_ = port();
  }
  void Disable() override {
    port().turn_off();
    last_ = port();
  }

 private:
  hal::ScannerDrive last_;
};

class ScannerDistances final : public SensorOn<argos::CCI_FootBotDistanceScannerSensor, hal::DistanceScanner> {
 public:
  void sense() override {
    const hal::DistanceScanner& scanner = port();
    m_tReadingsMap.clear();
    m_tShortReadingsMap.clear();
    m_tLongReadingsMap.clear();
    for (std::size_t head = 0; head < hal::DistanceScanner::kHeads; ++head) {
      for (std::size_t sample = 0; sample < scanner.samples; ++sample) {
        const double distance = scanner.too_near(head, sample) ? -1.0
                                : scanner.sees_nothing(head, sample)
                                    ? -2.0
                                    : static_cast<double>(scanner.distance(head, sample)) / kM_per_cm;
        const CRadians angle(static_cast<double>(scanner.angle(head, sample)));
        (hal::DistanceScanner::is_short(head) ? m_tShortReadingsMap : m_tLongReadingsMap)[angle] = distance;
        m_tReadingsMap[angle] = distance;
      }
    }
  }
};

/// Where the configuration lists `flight_task` and `flight_state`, commands have a robot that stands on the ground take
/// off first. Without them a real one stays there.
class TakeOff {
 public:
  void fit(const Fitting& fitting) {
    task_ = fitting.find<hal::FlightTask>();
    state_ = fitting.find<hal::FlightState>();
  }
  void order() noexcept {
    if (task_ == nullptr || state_ == nullptr) return;
    const bool stands = state_->phase == hal::FlightPhase::Off || state_->phase == hal::FlightPhase::Landed ||
                        state_->phase == hal::FlightPhase::TakingOff;
    task_->order = stands ? hal::FlightOrder::TakeOff : hal::FlightOrder::Fly;
  }

 private:
  hal::FlightTask* task_ = nullptr;
  const hal::FlightState* state_ = nullptr;
};

class FlightTo final : public ActuatorOn<argos::CCI_QuadRotorPositionActuator, hal::QuadrotorPosition> {
 public:
  void SetAbsolutePosition(const CVector3& p) override { go_to({p.GetX(), p.GetY(), p.GetZ()}); }
  void SetRelativePosition(const CVector3& p) override {
    go_to(hal::argos::from_body(place(), {p.GetX(), p.GetY(), p.GetZ()}));
  }
  void SetAbsoluteYaw(const CRadians& yaw) override { port().yaw_rad = yaw.GetValue(); }
  void SetRelativeYaw(const CRadians& yaw) override { port().yaw_rad = hal::argos::yaw_of(place()) + yaw.GetValue(); }

 private:
  void fit(const Fitting& fitting) override {
    place_ = fitting.find<hal::Positioning>();
    take_off_.fit(fitting);
  }
  void go_to(const std::array<double, 3>& p_W) {
    port().set(p_W[0], p_W[1], p_W[2], port().yaw_rad);
    take_off_.order();
  }
  const hal::Positioning& place() const {
    if (place_ == nullptr)
      THROW_ARGOSEXCEPTION(
          "a place or heading relative to the robot's needs the sensor 'positioning' in the controller's configuration")
    return *place_;
  }
  const hal::Positioning* place_ = nullptr;
  TakeOff take_off_;
};

class FlightWith final : public ActuatorOn<argos::CCI_QuadRotorSpeedActuator, hal::QuadrotorSpeed> {
 public:
  void SetLinearVelocity(const CVector3& v) override {
    port().set(v.GetX(), v.GetY(), v.GetZ(), port().yaw_rad_s);
    take_off_.order();
  }
  void SetRotationalSpeed(const CRadians& speed) override { port().yaw_rad_s = speed.GetValue(); }

 private:
  void fit(const Fitting& fitting) override { take_off_.fit(fitting); }
  TakeOff take_off_;
};

class HeadOf final : public ActuatorOn<argos::CCI_PanTiltCameraActuator, hal::PanTiltDrive> {
 public:
  void SetPan(const CRadians& pan) override { port().pan_rad = pan.GetValue(); }
  void SetTilt(const CRadians& tilt) override { port().tilt_rad = tilt.GetValue(); }
};

}  // namespace

std::span<const DeviceClass> motion_classes() {
  using namespace argos;
  static const std::array all = {device_class<WheelsOf<CCI_DifferentialSteeringActuator>>("differential_steering"),
                                 device_class<WheelsOf<CCI_EPuckWheelsActuator>>("epuck_wheels"),
                                 device_class<EncodersOf<CCI_DifferentialSteeringSensor>>("differential_steering"),
                                 device_class<EncodersOf<CCI_FootBotEncoderSensor>>("footbot_encoder"),
                                 device_class<EncodersOf<CCI_EPuckEncoderSensor>>("epuck_encoder"),
                                 device_class<TurretOf>("footbot_turret"),
                                 device_class<TurretAngle>("footbot_turret_encoder"),
                                 device_class<FootbotGripper>("footbot_gripper"),
                                 device_class<PlainGripper>("gripper"),
                                 device_class<ScannerMotor>("footbot_distance_scanner"),
                                 device_class<ScannerDistances>("footbot_distance_scanner"),
                                 device_class<FlightTo>("quadrotor_position"),
                                 device_class<FlightWith>("quadrotor_speed"),
                                 device_class<HeadOf>("pan_tilt_camera")};
  return all;
}

}  // namespace tandem::compat::argos3
