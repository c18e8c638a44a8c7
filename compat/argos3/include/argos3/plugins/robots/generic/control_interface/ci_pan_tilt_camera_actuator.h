// The head of the eye-bot's camera.
#ifndef TANDEM_ARGOS3_CI_PAN_TILT_CAMERA_ACTUATOR_H
#define TANDEM_ARGOS3_CI_PAN_TILT_CAMERA_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_PanTiltCameraActuator : public CCI_Actuator {
 public:
  virtual void SetPan(const CRadians& pan) = 0;
  virtual void SetTilt(const CRadians& tilt) = 0;
};

}  // namespace argos

#endif
