// CProximitySensorEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CProximitySensorEquippedEntity (proximity_sensor_equipped_entity.h). Ask the robot's controller for its proximity sensor."
