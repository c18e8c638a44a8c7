// Lit LEDs all around.
#ifndef TANDEM_ARGOS3_CI_COLORED_BLOB_OMNIDIRECTIONAL_CAMERA_SENSOR_H
#define TANDEM_ARGOS3_CI_COLORED_BLOB_OMNIDIRECTIONAL_CAMERA_SENSOR_H
#include <iostream>
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_ColoredBlobOmnidirectionalCameraSensor : public CCI_Sensor {
 public:
  struct SBlob {
    CColor Color;
    CRadians Angle;       ///< counter-clockwise from forward
    Real Distance = 0.0;  ///< in cm

    SBlob() {}
    SBlob(const CColor& color, const CRadians& angle, Real distance) : Color(color), Angle(angle), Distance(distance) {}

    friend std::ostream& operator<<(std::ostream& out, const SBlob& blob) {
      return out << "(Color = " << blob.Color << ",Angle = " << ToDegrees(blob.Angle) << ",Distance = " << blob.Distance << ")";
    }
  };
  typedef std::vector<SBlob*> TBlobList;
  struct SReadings {
    TBlobList BlobList;
    UInt64 Counter = 0;  ///< of images

    friend std::ostream& operator<<(std::ostream& out, const SReadings& readings) {
      out << "Counter: " << readings.Counter << std::endl;
      for (size_t i = 0; i < readings.BlobList.size(); ++i)
        out << "Blob[" << i << "]: " << *readings.BlobList[i] << std::endl;
      return out;
    }
  };
  /// The nearest first. Empty while the sensor is disabled, as it is at the start.
  const SReadings& GetReadings() const { return m_sReadings; }

 protected:
  SReadings m_sReadings;
};

}  // namespace argos

#endif
