// CSimpleRadioEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CSimpleRadioEquippedEntity (simple_radio_equipped_entity.h). Use CRABEquippedEntity."
