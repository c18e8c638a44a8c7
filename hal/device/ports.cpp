#include "hal/device/ports.hpp"

#include "hal/device/body_sensors.hpp"
#include "hal/device/brakes.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/fitted.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/selector.hpp"
#include "hal/device/speaker.hpp"
#include "hal/device/steppers.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::hal {

namespace {

template <class... Port>
void add_all(Registrar& registrar) {
  (registrar.add(port_type<Port>()), ...);
}

template <class... Part>
void add_parts(Registrar& registrar) {
  (registrar.add(part_type<Part>()), ...);
}

}  // namespace

void register_ports(Registrar& registrar) {
  add_all<WheelSpeeds, WheelEncoders, Proximity, Light, Ground, Accelerometer, Microphones, Battery, Clock, RingLeds,
          BodyLed, FrontLed, RangeAndBearing, RangeAndBearingSend, QuadrotorPosition, QuadrotorSpeed, Positioning,
          Odometry, Gyroscope, BaseGround, MotorGround, TurretDrive, TurretEncoder, GripperDrive, Gripper, ScannerDrive,
          DistanceScanner, OmnidirectionalCamera, PerspectiveCamera, UpperRingLeds, QuadrotorAttitude, FlightTask,
          FlightState, Altimeter, CameraLed, PanTiltDrive, PanTiltEncoder, TimeOfFlight, Cliff, Selector, Buttons,
          Speaker, RangeAndBearingMany, RangeAndBearingLongSend, OmnidirectionalCameraMany, PerspectiveCameraMany>(
      registrar);
  add_parts<ProximityPart, LightPart, GroundPart, BaseGroundPart, MotorGroundPart, AccelerometerPart, GyroscopePart,
            MicrophonesPart, BatteryPart, RangeAndBearingPart, LedsPart, UpperLedsPart, BodyLedPart, FrontLedPart,
            CameraLedPart, TurretPart, GripperPart, ScannerPart, OmniCameraPart, CameraPart, HeadPart, AltimeterPart,
            TimeOfFlightPart, CliffPart, SelectorPart, ButtonsPart, SpeakerPart, BrakesPart, SteppersPart, FittedWheels,
            FittedProximity, LookPart>(registrar);
}

}  // namespace tandem::hal
