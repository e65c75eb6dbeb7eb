"""The processor's instruction to bring a line of memory into its cache."""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

#: bytes
CACHE_LINE = 64


@intrinsic
def prefetch(typingctx, array, row, line):
    """Have the cache line number `line` of a row of an array brought into the cache; nothing waits for it, and nothing is read.

    The row begins where `array[row]` does; lines beyond it are fetched as well, if only they are mapped.
    """
    signature = types.void(array, types.intp, types.intp)

    def code(context, builder, signature, arguments):
        held = context.make_array(signature.args[0])(context, builder, arguments[0])
        stride = builder.extract_value(held.strides, 0)
        lines = builder.mul(arguments[2], ir.Constant(arguments[2].type, CACHE_LINE))
        offset = builder.add(builder.mul(arguments[1], stride), lines)
        byte = ir.IntType(8)
        start = builder.bitcast(held.data, byte.as_pointer())
        address = builder.gep(start, [offset], source_etype=byte)
        flag = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [address.type, flag, flag, flag])
        call = builder.module.globals.get("llvm.prefetch.p0") or ir.Function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(call, [address, flag(0), flag(2), flag(1)])
        return context.get_dummy_value()

    return signature, code
