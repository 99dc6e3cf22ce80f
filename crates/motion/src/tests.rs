mod figures;
mod made_up;
mod measured;
