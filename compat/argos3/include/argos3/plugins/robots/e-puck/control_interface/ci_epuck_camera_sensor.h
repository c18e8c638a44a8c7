// CCI_EPuckCameraSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_EPuckCameraSensor (ci_epuck_camera_sensor.h). Use CCI_EPuckOmnidirectionalCameraSensor, or a camera of our own (docs/controllers.md)."
