// CDirectionalLEDEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CDirectionalLEDEquippedEntity (directional_led_equipped_entity.h). Use CLEDEquippedEntity."
