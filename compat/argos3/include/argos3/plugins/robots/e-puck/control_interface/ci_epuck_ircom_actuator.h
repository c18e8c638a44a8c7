// CCI_EPuckIRComActuator: not on our robots.
#error "Tandem's ARGoS layer has no CCI_EPuckIRComActuator (ci_epuck_ircom_actuator.h). Use CCI_EPuckRangeAndBearingActuator, device epuck_range_and_bearing."
