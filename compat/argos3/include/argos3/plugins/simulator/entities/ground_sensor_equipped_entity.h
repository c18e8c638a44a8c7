// CGroundSensorEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CGroundSensorEquippedEntity (ground_sensor_equipped_entity.h). Ask the robot's controller for its ground sensor."
