// CCI_DirectionalLEDsActuator: not on our robots.
#error "Tandem's ARGoS layer has no CCI_DirectionalLEDsActuator (ci_directional_leds_actuator.h). Use CCI_LEDsActuator, device leds."
