mod figures;
mod planar_ship;
