// CCI_TagsActuator: not on our robots.
#error "Tandem's ARGoS layer has no CCI_TagsActuator (ci_tags_actuator.h). Use CCI_LEDsActuator, device leds."
