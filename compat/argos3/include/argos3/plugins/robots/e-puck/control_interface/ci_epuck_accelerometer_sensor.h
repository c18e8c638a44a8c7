// CCI_EPuckAccelerometerSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_EPuckAccelerometerSensor (ci_epuck_accelerometer_sensor.h). It is not implemented in ARGoS either; write the controller against ours (docs/controllers.md)."
