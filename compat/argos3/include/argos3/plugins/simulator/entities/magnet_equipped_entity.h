// CMagnetEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CMagnetEquippedEntity (magnet_equipped_entity.h). Use boxes and cylinders, which robots push and grip."
