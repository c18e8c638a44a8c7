// CCI_EPuckVirtualCamrabSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_EPuckVirtualCamrabSensor (ci_epuck_virtual_camrab_sensor.h). Use CCI_EPuckRangeAndBearingSensor and CCI_EPuckOmnidirectionalCameraSensor."
