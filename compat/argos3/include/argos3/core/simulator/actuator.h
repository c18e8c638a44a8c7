// CSimulatedActuator: not carried over.
#error "Tandem's ARGoS layer has no CSimulatedActuator (actuator.h). Make a plug-in with a device of ours (docs/plugins.md)."
