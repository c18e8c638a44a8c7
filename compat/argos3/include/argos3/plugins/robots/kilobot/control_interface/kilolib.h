// kilolib: not carried over.
#error "Tandem's ARGoS layer has no kilolib (kilolib.h). Describe the robot as a kind of ours (docs/robot-files.md)."
