mod figures;
mod made_up;
