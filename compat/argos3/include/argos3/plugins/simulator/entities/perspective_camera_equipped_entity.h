// CPerspectiveCameraEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CPerspectiveCameraEquippedEntity (perspective_camera_equipped_entity.h). Ask the robot's controller for its camera."
