// Messages of the e-puck's board, 4 bytes each.
#ifndef TANDEM_ARGOS3_CI_EPUCK_RANGE_AND_BEARING_ACTUATOR_H
#define TANDEM_ARGOS3_CI_EPUCK_RANGE_AND_BEARING_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>

namespace argos {

class CCI_EPuckRangeAndBearingActuator : public CCI_Actuator {
 public:
  static const UInt32 MAX_BYTES_SENT = 4;
  typedef UInt8 TData[MAX_BYTES_SENT];

  /// Sends it in every tick, from all emitters. Bytes beyond the robot's message size (`rab_data_size`) are left out.
  virtual void SetData(const TData data) = 0;
  /// Our board sends the same to all sides. @throws CARGoSException, which says so
  virtual void SetDataForEmitter(size_t emitter, const TData data) = 0;
  /// Sends nothing until data are set.
  virtual void Disable() = 0;
  virtual void DisableEmitter(size_t emitter) = 0;
};

}  // namespace argos

#endif
