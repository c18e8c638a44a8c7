// The foot-bot's wheel encoders.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_ENCODER_SENSOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_ENCODER_SENSOR_H
#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

class CCI_FootBotEncoderSensor : public CCI_Sensor {
 public:
  /// In cm; ways of the last tick.
  struct SReading {
    Real CoveredDistanceLeftWheel = 0.0;
    Real CoveredDistanceRightWheel = 0.0;
    Real WheelAxisLength = 0.0;

    SReading() {}
    SReading(Real left, Real right, Real axis)
        : CoveredDistanceLeftWheel(left), CoveredDistanceRightWheel(right), WheelAxisLength(axis) {}
  };
  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos

#endif
