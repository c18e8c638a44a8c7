// The e-puck's wheel encoders.
#ifndef TANDEM_ARGOS3_CI_EPUCK_ENCODER_SENSOR_H
#define TANDEM_ARGOS3_CI_EPUCK_ENCODER_SENSOR_H
#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

class CCI_EPuckEncoderSensor : public CCI_Sensor {
 public:
  static const Real WHEEL_AXIS_LENGTH;  ///< in cm

  /// In cm, of the last tick.
  struct SReading {
    Real CoveredDistanceLeftWheel = 0.0;
    Real CoveredDistanceRightWheel = 0.0;

    SReading() {}
    SReading(Real left, Real right) : CoveredDistanceLeftWheel(left), CoveredDistanceRightWheel(right) {}
  };
  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos

#endif
