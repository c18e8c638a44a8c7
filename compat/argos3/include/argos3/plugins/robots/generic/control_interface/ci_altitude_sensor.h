// CCI_AltitudeSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_AltitudeSensor (ci_altitude_sensor.h). Use CCI_PositioningSensor, device positioning."
