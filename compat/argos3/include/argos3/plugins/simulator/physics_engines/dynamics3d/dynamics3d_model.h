// CDynamics3DModel: not carried over.
#error "Tandem's ARGoS layer has no CDynamics3DModel (dynamics3d_model.h). Bodies belong to engines of ours; own ones are plug-ins (docs/engines.md)."
