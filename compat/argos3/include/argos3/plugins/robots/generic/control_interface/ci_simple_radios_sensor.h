// CCI_SimpleRadiosSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_SimpleRadiosSensor (ci_simple_radios_sensor.h). Use CCI_RangeAndBearingSensor, device range_and_bearing."
