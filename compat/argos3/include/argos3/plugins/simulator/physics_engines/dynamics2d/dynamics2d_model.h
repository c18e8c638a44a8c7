// CDynamics2DModel: not carried over.
#error "Tandem's ARGoS layer has no CDynamics2DModel (dynamics2d_model.h). Bodies belong to engines of ours; own ones are plug-ins (docs/engines.md)."
