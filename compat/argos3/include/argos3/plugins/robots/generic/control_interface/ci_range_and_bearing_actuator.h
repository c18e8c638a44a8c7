// Messages to the robots in range.
#ifndef TANDEM_ARGOS3_CI_RANGE_AND_BEARING_ACTUATOR_H
#define TANDEM_ARGOS3_CI_RANGE_AND_BEARING_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/byte_array.h>

namespace argos {

/// The message is sent in every tick, all zeros until it is set.
class CCI_RangeAndBearingActuator : public CCI_Actuator {
 public:
  size_t GetSize() const { return m_cData.Size(); }
  /// @throws CARGoSException unless it has GetSize() bytes
  virtual void SetData(const CByteArray& data) = 0;
  virtual void SetData(size_t i, UInt8 value) = 0;
  virtual void ClearData() = 0;

 protected:
  CByteArray m_cData;
};

}  // namespace argos

#endif
