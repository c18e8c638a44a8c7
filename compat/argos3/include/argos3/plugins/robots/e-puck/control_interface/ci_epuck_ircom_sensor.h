// CCI_EPuckIRComSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_EPuckIRComSensor (ci_epuck_ircom_sensor.h). Use CCI_EPuckRangeAndBearingSensor, device epuck_range_and_bearing."
