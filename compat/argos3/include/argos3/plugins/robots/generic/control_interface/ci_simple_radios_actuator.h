// CCI_SimpleRadiosActuator: not on our robots.
#error "Tandem's ARGoS layer has no CCI_SimpleRadiosActuator (ci_simple_radios_actuator.h). Use CCI_RangeAndBearingActuator, device range_and_bearing."
