// CGripperEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CGripperEquippedEntity (gripper_equipped_entity.h). Ask the robot's controller for its gripper."
