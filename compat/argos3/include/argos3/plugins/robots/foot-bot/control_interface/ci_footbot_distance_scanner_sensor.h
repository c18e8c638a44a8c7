// Distances of the foot-bot's scanner.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_DISTANCE_SCANNER_SENSOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_DISTANCE_SCANNER_SENSOR_H
#include <map>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_FootBotDistanceScannerSensor : public CCI_Sensor {
 public:
  /// By where the head looked: distances in cm from the robot's axis; -1 too near, -2 nothing there.
  typedef std::map<CRadians, Real> TReadingsMap;

  const TReadingsMap& GetReadingsMap() const { return m_tReadingsMap; }
  const TReadingsMap& GetShortReadingsMap() const { return m_tShortReadingsMap; }
  const TReadingsMap& GetLongReadingsMap() const { return m_tLongReadingsMap; }

 protected:
  TReadingsMap m_tReadingsMap, m_tShortReadingsMap, m_tLongReadingsMap;
};

}  // namespace argos

#endif
