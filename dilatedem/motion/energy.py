"""The energies of an instant: with the running sums of `state.ledger.Ledger` they close the ledger of a run."""

from dilatedem.contact.spring import length
from dilatedem.jit import item
from dilatedem.motion.integrate import kinetic_energy
from dilatedem.motion.modal import modal_energy
from dilatedem.numerics.rotation import rotation_matrix
from dilatedem.numerics.vector import load
from dilatedem.state.ledger import BUOYANCY, ELASTIC, GRAVITY, KINETIC, KINETIC_WATER, MODAL
from dilatedem.state.response import is_free, water_energies
from dilatedem.water.bent import bent_buoyancy
from dilatedem.water.floating import submerge


@item
def book_energies(model, bodies, pairs, workspace, ledger):
    """Kinetic energy of bodies and of the water they take along, energy of weight and of buoyancy, elastic energy of all contacts
    at this instant, to the ledger.

    Buoyancy: the water a body has displaced was lifted from the centre of buoyancy to the surface, -rho g V z_B, whose gradient
    is the buoyancy force and moment of any convex body.
    """
    kinetic = water = weight = buoyancy = elastic = modal = 0.0
    floating, solids, setting, hulls = model.floating, model.solids, model.loads, model.hulls
    q, wet = bodies.orientation, workspace.wet
    if setting.water:
        submerge(workspace.everybody, 0, floating, hulls, bodies, workspace, 0)
    for i in range(floating):
        if not is_free(i, solids):
            continue
        straight, turning = water_energies(i, solids, bodies)
        kinetic += kinetic_energy(i, solids, bodies) - turning
        water += straight + turning
        modal += modal_energy(i, solids, bodies)
        z = bodies.position[i, 2]
        weight += solids.mass[i] * setting.gravity * z
        if setting.water:
            up = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])[2]
            volume, cx, cy, cz = wet[i, 0], wet[i, 1], wet[i, 2], wet[i, 3]
            height = z + up[0] * cx + up[1] * cy + up[2] * cz
            buoyancy -= setting.water_density * setting.gravity * volume * height
            buoyancy += bent_buoyancy(i, setting, solids, bodies, workspace)
    for k in range(pairs.count[0]):
        if pairs.overlap[k] > 0.0:
            elastic += pairs.stored[k] + 0.5 * pairs.shear_stiffness[k] * length(load(pairs.slip, k), pairs.wrung[k]) ** 2
    stored = ledger.instant
    stored[KINETIC], stored[GRAVITY], stored[BUOYANCY], stored[ELASTIC] = kinetic, weight, buoyancy, elastic
    stored[KINETIC_WATER], stored[MODAL] = water, modal
