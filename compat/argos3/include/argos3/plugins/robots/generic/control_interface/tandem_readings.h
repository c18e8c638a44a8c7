// Readings that several sensors have alike.
#ifndef TANDEM_ARGOS3_READINGS_H
#define TANDEM_ARGOS3_READINGS_H
#include <iostream>
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

namespace tandem_detail {

/// A sensor of a ring.
struct SRingReading {
  Real Value;      ///< 0 to 1
  CRadians Angle;  ///< where it looks, counter-clockwise from forward

  SRingReading() : Value(0.0) {}
  SRingReading(Real value, const CRadians& angle) : Value(value), Angle(angle) {}
};

/// A sensor that looks at the floor.
struct SGroundReading {
  Real Value;       ///< 0 black to 1 white
  CVector2 Offset;  ///< from the robot's centre, in cm

  SGroundReading() : Value(0.0) {}
  SGroundReading(Real value, const CVector2& offset) : Value(value), Offset(offset) {}
};

inline std::ostream& operator<<(std::ostream& out, const SRingReading& reading) {
  return out << "Value=<" << reading.Value << ">, Angle=<" << reading.Angle << ">";
}
inline std::ostream& operator<<(std::ostream& out, const SGroundReading& reading) {
  return out << "Value=<" << reading.Value << ">, Offset=<" << reading.Offset << ">";
}
template <typename READING>
std::ostream& operator<<(std::ostream& out, const std::vector<READING>& readings) {
  for (size_t i = 0; i < readings.size(); ++i) out << (i == 0 ? "{ " : " | ") << readings[i];
  return out << (readings.empty() ? "{ }" : " }");
}

/// A list of readings of one class.
template <typename READING>
class CReadingsSensor : public CCI_Sensor {
 public:
  typedef READING SReading;
  typedef std::vector<READING> TReadings;

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  TReadings m_tReadings;
};

}  // namespace tandem_detail

}  // namespace argos

#endif
