// Messages that the e-puck's board received.
#ifndef TANDEM_ARGOS3_CI_EPUCK_RANGE_AND_BEARING_SENSOR_H
#define TANDEM_ARGOS3_CI_EPUCK_RANGE_AND_BEARING_SENSOR_H
#include <iostream>
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_EPuckRangeAndBearingSensor : public CCI_Sensor {
 public:
  static const UInt32 MAX_BYTES_RECEIVED = 4;
  typedef UInt8 TData[MAX_BYTES_RECEIVED];

  struct SReceivedPacket {
    Real Range = 0.0;  ///< in cm
    CRadians Bearing;  ///< counter-clockwise from forward
    TData Data = {0, 0, 0, 0};

    friend std::ostream& operator<<(std::ostream& out, const SReceivedPacket& packet) {
      out << "Range=<" << packet.Range << ">, Bearing=<" << packet.Bearing << ">, Data=<";
      for (UInt32 i = 0; i < 4; ++i) out << (i == 0 ? "" : ",") << static_cast<unsigned>(packet.Data[i]);
      return out << ">";
    }
  };
  typedef std::vector<SReceivedPacket*> TPackets;

  /// Those since ClearPackets, the oldest first; of 1000 at most.
  const TPackets& GetPackets() const { return m_tPackets; }
  virtual void ClearPackets() = 0;

 protected:
  TPackets m_tPackets;
};

}  // namespace argos

#endif
