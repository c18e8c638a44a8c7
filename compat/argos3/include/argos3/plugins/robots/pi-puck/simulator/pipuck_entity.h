// CPiPuckEntity: not carried over.
#error "Tandem's ARGoS layer has no CPiPuckEntity (pipuck_entity.h). Describe the robot as a kind of ours (docs/robot-files.md)."
