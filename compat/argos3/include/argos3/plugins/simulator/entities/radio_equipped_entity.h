// CRadioEquippedEntity: not carried over.
#error "Tandem's ARGoS layer has no CRadioEquippedEntity (radio_equipped_entity.h). Use CRABEquippedEntity."
