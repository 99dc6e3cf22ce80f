mod figures;
mod made_up;
mod made_up_hull;
mod measured;
mod measured_hull;
mod steered;
