// CCI_EPuckVirtualCamrabActuator: not on our robots.
#error "Tandem's ARGoS layer has no CCI_EPuckVirtualCamrabActuator (ci_epuck_virtual_camrab_actuator.h). Use CCI_EPuckRangeAndBearingActuator and CCI_EPuckRGBLEDsActuator."
