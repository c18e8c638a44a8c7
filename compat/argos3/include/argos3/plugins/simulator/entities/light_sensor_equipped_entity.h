// CLightSensorEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CLightSensorEquippedEntity (light_sensor_equipped_entity.h). Ask the robot's controller for its light sensor."
