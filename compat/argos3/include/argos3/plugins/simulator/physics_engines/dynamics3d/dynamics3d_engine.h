// CDynamics3DEngine: not carried over.
#error "Tandem's ARGoS layer has no CDynamics3DEngine (dynamics3d_engine.h). Bodies belong to engines of ours; own ones are plug-ins (docs/engines.md)."
