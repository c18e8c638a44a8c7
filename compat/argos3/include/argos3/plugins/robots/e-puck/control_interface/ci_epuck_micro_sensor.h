// CCI_EPuckMicroSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_EPuckMicroSensor (ci_epuck_micro_sensor.h). It is not implemented in ARGoS either; write the controller against ours (docs/controllers.md)."
