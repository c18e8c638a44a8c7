// CWiFiEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CWiFiEquippedEntity (wifi_equipped_entity.h). Ask the robot's controller for its range-and-bearing sensor and actuator."
