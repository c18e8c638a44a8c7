// Wheel encoders.
#ifndef TANDEM_ARGOS3_CI_DIFFERENTIAL_STEERING_SENSOR_H
#define TANDEM_ARGOS3_CI_DIFFERENTIAL_STEERING_SENSOR_H
#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

class CCI_DifferentialSteeringSensor : public CCI_Sensor {
 public:
  /// Speeds in cm/s, distances in cm: those of the last tick.
  struct SReading {
    Real VelocityLeftWheel = 0.0;
    Real VelocityRightWheel = 0.0;
    Real CoveredDistanceLeftWheel = 0.0;
    Real CoveredDistanceRightWheel = 0.0;
    Real WheelAxisLength = 0.0;

    SReading() {}
    SReading(Real left, Real right, Real left_way, Real right_way, Real axis)
        : VelocityLeftWheel(left),
          VelocityRightWheel(right),
          CoveredDistanceLeftWheel(left_way),
          CoveredDistanceRightWheel(right_way),
          WheelAxisLength(axis) {}
  };
  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos

#endif
