// CQuadRotorEntity: not carried over.
#error "Tandem's ARGoS layer has no CQuadRotorEntity (quadrotor_entity.h). Ask the robot's controller for its flight actuator."
