// CCI_CameraSensor: not on our robots.
#error "Tandem's ARGoS layer has no CCI_CameraSensor (ci_camera_sensor.h). Use CCI_ColoredBlobPerspectiveCameraSensor or CCI_ColoredBlobOmnidirectionalCameraSensor."
