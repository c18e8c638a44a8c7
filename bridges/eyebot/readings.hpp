// Conversions between the robot's messages and ports. Pure; stamps are left to others.
#pragma once
#include "bridges/eyebot/world_frame.hpp"
#include "bridges/eyebot_messages/messages.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot {

void read(const eyebot_messages::State& m, const WorldFrame& world, hal::Positioning& port) noexcept;
/// Velocity and turn rate; phase and fail-safe are the status's.
void read(const eyebot_messages::State& m, const WorldFrame& world, hal::FlightState& port) noexcept;
void read(const eyebot_messages::State& m, hal::Gyroscope& port) noexcept;
void read(const eyebot_messages::Status& m, hal::FlightState& port) noexcept;
void read(const eyebot_messages::Altitude& m, hal::Altimeter& port) noexcept;
/// A charge that the robot does not know is taken from the voltage, along a straight line from empty to full.
void read(const eyebot_messages::Battery& m, const hal::RobotKind& kind, hal::Battery& port) noexcept;
/// Of each head the newest samples; a head that has fewer than another looks into emptiness for the rest.
void read(const eyebot_messages::Scan& m, const hal::RobotKind& kind, hal::DistanceScanner& port) noexcept;
void read(const eyebot_messages::Prox& m, const hal::RobotKind& kind, hal::Proximity& port) noexcept;
void read(const eyebot_messages::Light& m, const hal::RobotKind& kind, hal::Light& port) noexcept;
void read(const eyebot_messages::PanTilt& m, hal::PanTiltEncoder& port) noexcept;
/// The nearest first; those of unknown distance behind them, in their order.
void read(const eyebot_messages::Blobs& m, hal::PerspectiveCamera& port) noexcept;
/// Adds the packets; payloads are cut to what the port holds.
void add(const eyebot_messages::Rab& m, hal::RangeAndBearing& port) noexcept;

/// `lower`, `upper`, `camera`: null for lights without commands; the robot then keeps them as they are.
void write(const hal::RingLeds* lower, const hal::UpperRingLeds* upper, const hal::CameraLed* camera,
           eyebot_messages::Leds& m) noexcept;
void write(const hal::PanTiltDrive& port, eyebot_messages::CmdPanTilt& m) noexcept;
void write(const hal::ScannerDrive& port, eyebot_messages::CmdScanner& m) noexcept;
/// `m.data` must have room for 10 bytes, so that nothing is allocated.
void write(const hal::RangeAndBearingSend& port, eyebot_messages::CmdRab& m) noexcept;
void write(const hal::QuadrotorSpeed& port, const WorldFrame& world, eyebot_messages::CmdVelocity& m) noexcept;
void write(const hal::QuadrotorPosition& port, const WorldFrame& world, eyebot_messages::CmdPosition& m) noexcept;

}  // namespace tandem::bridges::eyebot
