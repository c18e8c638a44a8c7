// CSimulatedSensor: not carried over.
#error "Tandem's ARGoS layer has no CSimulatedSensor (sensor.h). Make a plug-in with a device of ours (docs/plugins.md)."
