// CTagEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CTagEquippedEntity (tag_equipped_entity.h). Use CLEDEquippedEntity."
