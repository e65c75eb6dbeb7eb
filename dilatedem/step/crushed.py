"""Ice that has crushed on structures since the start: its volume, and the depth of the deepest dent."""

from dilatedem.contact.crushing.depth import bearing_pressure
from dilatedem.jit import by_type, item
from dilatedem.state.ledger import LOSS_CRUSHING
from dilatedem.state.loads import DEPTH, VOLUME
from dilatedem.state.response import stride_of
from dilatedem.state.setting import CRUSHING_SETTINGS


@item
def _record_nothing(contact, count, structure_of, records, pairs, workspace, loads):
    pass


@item
def _record_crushed(contact, count, structure_of, records, pairs, workspace, loads):
    """Bring what crushed in strides that end now at near pairs with a structure, `count` of them, to the structures and their sums.

    The volume is what crushing cost over the pressure that it was done at.
    """
    for w in range(count):
        k = workspace.at_structure[w]
        if pairs.crushed[k] > 0.0 and pairs.overlap[k] > 0.0 and stride_of(pairs.a[k], pairs.b[k], workspace) > 0:
            s = max(structure_of[pairs.a[k]], structure_of[pairs.b[k]])
            loads.crushed[s, VOLUME] += pairs.cost[k, LOSS_CRUSHING] / bearing_pressure(contact, pairs.bears[k])
            loads.crushed[s, DEPTH] = max(loads.crushed[s, DEPTH], pairs.crushed[k])
    for t in range(len(records.total)):
        row = records.total[t]
        loads.crushed[row, VOLUME] = 0.0
        for w in range(records.start[t], records.start[t + 1]):
            s = records.member[w]
            loads.crushed[row, VOLUME] += loads.crushed[s, VOLUME]
            loads.crushed[row, DEPTH] = max(loads.crushed[row, DEPTH], loads.crushed[s, DEPTH])


#: What has crushed on structures, by the type of the contact setting.
record_crushed = by_type(_record_nothing, dict.fromkeys(CRUSHING_SETTINGS, _record_crushed))
