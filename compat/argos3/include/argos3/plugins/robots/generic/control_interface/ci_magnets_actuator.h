// CCI_MagnetsActuator: not on our robots.
#error "Tandem's ARGoS layer has no CCI_MagnetsActuator (ci_magnets_actuator.h). Use CCI_GripperActuator, device gripper."
