// The e-puck's three ground sensors.
#ifndef TANDEM_ARGOS3_CI_EPUCK_GROUND_SENSOR_H
#define TANDEM_ARGOS3_CI_EPUCK_GROUND_SENSOR_H
#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

class CCI_EPuckGroundSensor : public CCI_Sensor {
 public:
  /// 0 black to 1 white.
  struct SReadings {
    Real Left = 0.0;
    Real Center = 0.0;
    Real Right = 0.0;

    void Reset() { Left = Center = Right = 0.0; }
    Real& operator[](size_t i) {
      if (i > 2) THROW_ARGOSEXCEPTION("the e-puck has the ground sensors 0 to 2, not " << i)
      return i == 0 ? Left : i == 1 ? Center : Right;
    }
    const Real& operator[](size_t i) const { return const_cast<SReadings&>(*this)[i]; }
  };
  const SReadings& GetReadings() const { return m_sReadings; }
  void GetReadings(Real* buffer) const {
    for (size_t i = 0; i < 3; ++i) buffer[i] = m_sReadings[i];
  }
  Real GetReading(size_t i) { return m_sReadings[i]; }

 protected:
  SReadings m_sReadings;
};

}  // namespace argos

#endif
