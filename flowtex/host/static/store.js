// Built from client/src by client/build.js; change that instead.
/*! Holds parts of zarrita, of which this is the licence:

MIT License

Copyright (c) 2020-2023 Trevor Manz

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
"use strict";var flowtexStore=(()=>{var __create=Object.create;var __defProp=Object.defineProperty;var __getOwnPropDesc=Object.getOwnPropertyDescriptor;var __getOwnPropNames=Object.getOwnPropertyNames;var __getProtoOf=Object.getPrototypeOf,__hasOwnProp=Object.prototype.hasOwnProperty;var __require=(x=>typeof require<"u"?require:typeof Proxy<"u"?new Proxy(x,{get:(a,b)=>(typeof require<"u"?require:a)[b]}):
x)(function(x){if(typeof require<"u")return require.apply(this,arguments);throw Error('Dynamic require of "'+x+'" is not\
 supported')});var __export=(target,all)=>{for(var name in all)__defProp(target,name,{get:all[name],enumerable:!0})},__copyProps=(to,from,except,desc)=>{
if(from&&typeof from=="object"||typeof from=="function")for(let key of __getOwnPropNames(from))!__hasOwnProp.call(to,key)&&
key!==except&&__defProp(to,key,{get:()=>from[key],enumerable:!(desc=__getOwnPropDesc(from,key))||desc.enumerable});return to};var __toESM=(mod,isNodeMode,target)=>(target=mod!=null?__create(__getProtoOf(mod)):{},__copyProps(isNodeMode||!mod||!mod.
__esModule?__defProp(target,"default",{value:mod,enumerable:!0}):target,mod)),__toCommonJS=mod=>__copyProps(__defProp({},
"__esModule",{value:!0}),mod);var store_exports={};__export(store_exports,{open:()=>open2});function fromHalf(bits){let exponent=bits>>10&31,part=bits&1023,size;return exponent===0?size=part*2**-24:exponent===31?
size=part?NaN:1/0:size=(1024+part)*2**(exponent-25),bits&32768?-size:size}var HALVES=Float32Array.from({length:65536},(_,bits)=>fromHalf(
bits)),SINGLE=new Float32Array(1),BITS=new Uint32Array(SINGLE.buffer);function toHalf(x){SINGLE[0]=x;let sign=BITS[0]>>>
16&32768,size=BITS[0]&2147483647;return size>=1199566848?sign|(size>2139095040?32256:31744):size<947912704?sign|Math.round(
Math.abs(x)*2**24):sign|size-93952e4>>>13}var TYPES={float32:Float32Array,uint32:Uint32Array,float16:Uint16Array,uint16:Uint16Array,int16:Int16Array,int8:Int8Array,
uint8:Uint8Array};function stepOf(name){return Number(name.split("/")[1])}function tilePart(name){let[kind,level,row,column,...rest]=name.split("/");return kind==="tile"?[[level,row,column].join(
"/"),rest.join("/")]:null}function decoded(info,bytes){let view=ArrayBuffer.isView(bytes)?new Uint8Array(bytes.buffer,bytes.
byteOffset,bytes.byteLength):new Uint8Array(bytes),{name,dtype,shape,digest}=info,Type=TYPES[dtype];if(!Type)throw new Error(
`a part has the type "${dtype}"; expected ${Object.keys(TYPES).join(", ")}`);return{name,shape,digest,data:new Type(view.
slice().buffer)}}function partsOfFile(file){let[infos,first]=infosOfFile(new Uint8Array(file)),start=first;return infos.
map(info=>{let bytes=new Uint8Array(file,start,info.bytes);return start+=info.bytes,info.differences===void 0?decoded(info,
bytes):partOfPlanes(info,bytes)})}function infosOfFile(file){let first=4+new DataView(file.buffer,file.byteOffset).getUint32(
0,!0);return[JSON.parse(new TextDecoder().decode(file.subarray(4,first))),first]}var UNSIGNED={1:Uint8Array,2:Uint16Array,4:Uint32Array};function partOfPlanes(info,planes){let{shape,differences=[0,0],scale=null}=info,
count=shape.reduce((product,n)=>product*n,1),width=count?planes.length/count:1;if(!(width in UNSIGNED))throw new Error(`\
the packing of the part "${info.name}" is invalid`);let[line,channels]=shape.length>2?shape.slice(-2):[...shape,1].slice(
-2),numbers=new UNSIGNED[width](count);for(let c=0,from=0;c<channels;c+=1)for(let n=c;n<count;n+=channels,from+=1){let bits=0;
for(let plane=0;plane<width;plane+=1)bits|=planes[plane*count+from]<<8*plane;numbers[n]=bits>>>1^-(bits&1)}let row=line*
channels;for(let order=0;order<differences[0];order+=1)for(let n=row;n<count;n+=1)numbers[n]+=numbers[n-row];for(let order=0;order<
differences[1];order+=1)for(let first=0;first<count;first+=row)for(let n=first+channels;n<first+row;n+=1)numbers[n]+=numbers[n-
channels];return decoded(info,scale?floats(numbers,scale.map(exponent=>2**exponent)):numbers)}function floats(numbers,units){
let channels=units.length;return numbers instanceof Uint16Array?numbers.map((n,k)=>toHalf((n<<16>>16)*units[k%channels])):
new Float32Array(new Float64Array(numbers).map((n,k)=>(n|0)*units[k%channels]))}var ZarritaError=class extends Error{},NotFoundError=class extends ZarritaError{_tag="NotFoundError";name="NotFoundError";path;found;constructor(context,options={}){
super(`Not found: ${context}`,{cause:options.cause}),this.path=options.path,this.found=options.found}},InvalidMetadataError=class extends ZarritaError{_tag="\
InvalidMetadataError";name="InvalidMetadataError";path;constructor(message,options={}){super(message,{cause:options.cause}),
this.path=options.path}},UnknownCodecError=class extends ZarritaError{_tag="UnknownCodecError";name="UnknownCodecError";codec;constructor(codec){
super(`Unknown codec: ${codec}`),this.codec=codec}},CodecPipelineError=class extends ZarritaError{_tag="CodecPipelineErr\
or";name="CodecPipelineError";direction;codec;chunkPath;constructor(options){let parts=[`Failed to ${options.direction} \
chunk`,options.codec&&`via codec "${options.codec}"`,options.chunkPath&&`at ${options.chunkPath}`].filter(Boolean);super(
parts.join(" "),{cause:options.cause}),this.direction=options.direction,this.codec=options.codec,this.chunkPath=options.
chunkPath}};var UnsupportedError=class extends ZarritaError{_tag="UnsupportedError";name="UnsupportedError";feature;constructor(feature){
super(`Unsupported: ${feature}`),this.feature=feature}};function unimplementedEncode(codecName){return()=>{throw new UnsupportedError(`${codecName} encode`)}}var BitroundCodec=class _BitroundCodec{kind="array_to_array";constructor(configuration,_meta){if(configuration.keepbits<
0)throw new InvalidMetadataError("keepbits must be zero or positive")}static fromConfig(configuration,meta){return new _BitroundCodec(
configuration,meta)}encode=unimplementedEncode("bitround");decode(arr){return arr}};function isArrayBufferLike(x){return x instanceof ArrayBuffer||x instanceof SharedArrayBuffer}var BoolArray=class{#bytes;constructor(x,byteOffset,length2){
typeof x=="number"?this.#bytes=new Uint8Array(x):isArrayBufferLike(x)?this.#bytes=new Uint8Array(x,byteOffset,length2):this.#bytes=
new Uint8Array(Array.from(x,v=>v?1:0))}get BYTES_PER_ELEMENT(){return 1}get byteOffset(){return this.#bytes.byteOffset}get byteLength(){
return this.#bytes.byteLength}get buffer(){return this.#bytes.buffer}get length(){return this.#bytes.length}get(idx){let value=this.#bytes[idx];
return typeof value=="number"?value!==0:value}set(idx,value){this.#bytes[idx]=value?1:0}fill(value){this.#bytes.fill(value?
1:0)}*[Symbol.iterator](){for(let i=0;i<this.length;i++)yield this.get(i)}},ByteStringArray=class{_data;chars;#encoder;constructor(chars,x,byteOffset,length2){
if(this.chars=chars,this.#encoder=new TextEncoder,typeof x=="number")this._data=new Uint8Array(x*chars);else if(isArrayBufferLike(
x))length2&&(length2=length2*chars),this._data=new Uint8Array(x,byteOffset,length2);else{let values=Array.from(x);this._data=
new Uint8Array(values.length*chars);for(let i=0;i<values.length;i++)this.set(i,values[i])}}get BYTES_PER_ELEMENT(){return this.
chars}get byteOffset(){return this._data.byteOffset}get byteLength(){return this._data.byteLength}get buffer(){return this.
_data.buffer}get length(){return this.byteLength/this.BYTES_PER_ELEMENT}get(idx){let view=new Uint8Array(this.buffer,this.
byteOffset+this.chars*idx,this.chars);return new TextDecoder().decode(view).replace(/\x00/g,"")}set(idx,value){let view=new Uint8Array(
this.buffer,this.byteOffset+this.chars*idx,this.chars);view.fill(0),view.set(this.#encoder.encode(value))}fill(value){let encoded=this.#encoder.
encode(value);for(let i=0;i<this.length;i++)this._data.set(encoded,i*this.chars)}*[Symbol.iterator](){for(let i=0;i<this.
length;i++)yield this.get(i)}},UnicodeStringArray=class _UnicodeStringArray{#data;chars;constructor(chars,x,byteOffset,length2){
if(this.chars=chars,typeof x=="number")this.#data=new Int32Array(x*chars);else if(isArrayBufferLike(x))length2&&(length2*=
chars),this.#data=new Int32Array(x,byteOffset,length2);else{let values=x,d=new _UnicodeStringArray(chars,1);this.#data=new Int32Array(
(function*(){for(let str of values)d.set(0,str),yield*d.#data})())}}get BYTES_PER_ELEMENT(){return this.#data.BYTES_PER_ELEMENT*
this.chars}get byteLength(){return this.#data.byteLength}get byteOffset(){return this.#data.byteOffset}get buffer(){return this.#data.
buffer}get length(){return this.#data.length/this.chars}get(idx){let offset=this.chars*idx,result="";for(let i=0;i<this.
chars;i++)result+=String.fromCodePoint(this.#data[offset+i]);return result.replace(/\u0000/g,"")}set(idx,value){let offset=this.
chars*idx,view=this.#data.subarray(offset,offset+this.chars);view.fill(0);for(let i=0;i<this.chars;i++)view[i]=value.codePointAt(
i)??0}fill(value){this.set(0,value);let encoded=this.#data.subarray(0,this.chars);for(let i=1;i<this.length;i++)this.#data.
set(encoded,i*this.chars)}*[Symbol.iterator](){for(let i=0;i<this.length;i++)yield this.get(i)}};function assertSharedArrayBufferAvailable(){if(typeof SharedArrayBuffer>"u")throw new Error("SharedArrayBuffer is not av\
ailable. In browsers, this requires Cross-Origin-Opener-Policy and Cross-Origin-Embedder-Policy headers to be set.")}function createBuffer(byteLength,useShared){
return useShared?new SharedArrayBuffer(byteLength):new ArrayBuffer(byteLength)}function jsonDecodeObject(bytes){let str=new TextDecoder().
decode(bytes);try{return JSON.parse(str)}catch(cause){throw new InvalidMetadataError("Failed to decode JSON",{cause})}}function byteswapInplace(view,bytesPerElement2){
let numFlips=bytesPerElement2/2,endByteIndex=bytesPerElement2-1,t=0;for(let i=0;i<view.length;i+=bytesPerElement2)for(let j=0;j<
numFlips;j+=1)t=view[i+j],view[i+j]=view[i+endByteIndex-j],view[i+endByteIndex-j]=t}function getCtr(dataType){if(dataType===
"v2:object")return globalThis.Array;let match=dataType.match(/v2:([US])(\d+)/);if(match){let[,kind,chars]=match;return(kind===
"U"?UnicodeStringArray:ByteStringArray).bind(null,Number(chars))}if(dataType==="string")return globalThis.Array;let ctr={
int8:Int8Array,int16:Int16Array,int32:Int32Array,int64:globalThis.BigInt64Array,uint8:Uint8Array,uint16:Uint16Array,uint32:Uint32Array,
uint64:globalThis.BigUint64Array,float16:globalThis.Float16Array,float32:Float32Array,float64:Float64Array,bool:BoolArray}[dataType];
if(!ctr)throw new InvalidMetadataError(`Unknown or unsupported dataType: ${dataType}`);return ctr}function getStrides(shape,order){
let rank=shape.length;typeof order=="string"&&(order=order==="C"?Array.from({length:rank},(_,i)=>i):Array.from({length:rank},
(_,i)=>rank-1-i)),assert(rank===order.length,"Order length must match the number of dimensions.");let step=1,stride=new Array(
rank);for(let i=order.length-1;i>=0;i--)stride[order[i]]=step,step*=shape[order[i]];return stride}function createChunkKeyEncoder({
name,configuration}){if(name==="default"){let separator=configuration?.separator??"/";return chunkCoords=>["c",...chunkCoords].
join(separator)}if(name==="v2"){let separator=configuration?.separator??".";return chunkCoords=>chunkCoords.join(separator)||
"0"}throw new InvalidMetadataError(`Unknown chunk key encoding: ${name}`)}function coerceDtype(dtype){if(dtype==="|O")return{
dataType:"v2:object"};let match=dtype.match(/^([<|>])(.*)$/);if(!match)throw new InvalidMetadataError(`Invalid dtype: ${dtype}`);
let[,endian,rest]=match,dataType={b1:"bool",i1:"int8",u1:"uint8",i2:"int16",u2:"uint16",i4:"int32",u4:"uint32",i8:"int64",
u8:"uint64",f2:"float16",f4:"float32",f8:"float64"}[rest]??(rest.startsWith("S")||rest.startsWith("U")?`v2:${rest}`:void 0);
if(!dataType)throw new InvalidMetadataError(`Unsupported or unknown dtype: ${dtype}`);return endian==="|"?{dataType}:{dataType,
endian:endian==="<"?"little":"big"}}function isFixedScaleOffsetConfig(filter){return(filter.id==="fixedscaleoffset"||filter.
id==="numcodecs.fixedscaleoffset")&&typeof filter.scale=="number"&&typeof filter.offset=="number"&&(filter.astype===void 0||
typeof filter.astype=="string")&&(filter.dtype===void 0||typeof filter.dtype=="string")}function v2ToV3ArrayMetadata(meta,attributes={}){
let codecs=[],dtype=coerceDtype(meta.dtype);meta.order==="F"&&codecs.push({name:"transpose",configuration:{order:"F"}});
for(let filter of meta.filters??[]){if(filter.id==="fixedscaleoffset"||filter.id==="numcodecs.fixedscaleoffset"){if(!isFixedScaleOffsetConfig(
filter))throw new InvalidMetadataError(`Invalid fixedscaleoffset filter: ${JSON.stringify(filter)}`);codecs.push({name:"\
scale_offset",configuration:{scale:filter.scale,offset:filter.offset}});let astype=filter.astype??filter.dtype;if(astype!==
void 0&&astype!==meta.dtype){let castTarget=coerceDtype(astype).dataType;if(!isDataType(castTarget,"number")&&!isDataType(
castTarget,"bigint"))throw new InvalidMetadataError(`fixedscaleoffset astype must be a numeric data type, got ${astype}`);
codecs.push({name:"cast_value",configuration:{data_type:castTarget,rounding:"nearest-even",out_of_range:"wrap"}})}continue}
let{id,...configuration}=filter;codecs.push({name:`numcodecs.${id}`,configuration})}if("endian"in dtype&&dtype.endian===
"big"&&codecs.push({name:"bytes",configuration:{endian:"big"}}),meta.compressor){let{id,...configuration}=meta.compressor;
codecs.push({name:`numcodecs.${id}`,configuration})}let dimensionNames;return globalThis.Array.isArray(attributes._ARRAY_DIMENSIONS)&&
(dimensionNames=attributes._ARRAY_DIMENSIONS),{zarr_format:3,node_type:"array",shape:meta.shape,data_type:dtype.dataType,
chunk_grid:{name:"regular",configuration:{chunk_shape:meta.chunks}},chunk_key_encoding:{name:"v2",configuration:{separator:meta.
dimension_separator??"."}},codecs,fill_value:meta.fill_value,dimension_names:dimensionNames,attributes}}function v2ToV3GroupMetadata(_meta,attributes={}){
return{zarr_format:3,node_type:"group",attributes}}function isDataType(dtype,query){if(query!=="number"&&query!=="bigint"&&
query!=="boolean"&&query!=="object"&&query!=="string")return dtype===query;let isBoolean=dtype==="bool";if(query==="bool\
ean")return isBoolean;let isString=dtype.startsWith("v2:U")||dtype.startsWith("v2:S")||dtype==="string";if(query==="stri\
ng")return isString;let isBigint=dtype==="int64"||dtype==="uint64";if(query==="bigint")return isBigint;let isObject=dtype===
"v2:object";return query==="object"?isObject:!isString&&!isBigint&&!isBoolean&&!isObject}function isShardingCodec(codec){
return codec?.name==="sharding_indexed"}function ensureCorrectScalar(metadata){if((metadata.data_type==="uint64"||metadata.
data_type==="int64")&&metadata.fill_value!=null)return BigInt(metadata.fill_value);let isFloat=metadata.data_type==="flo\
at16"||metadata.data_type==="float32"||metadata.data_type==="float64";if(typeof metadata.fill_value=="string"&&isFloat){
let mapping={NaN:NaN,Infinity:1/0,"-Infinity":-1/0};if(metadata.fill_value in mapping)return mapping[metadata.fill_value]}
return metadata.fill_value}function rethrowUnless(error,...errors){if(!errors.some(ErrorClass=>error instanceof ErrorClass))throw error}function assert(expression,msg=""){
if(!expression)throw new Error(msg)}async function decompress(data,{format,signal}){let response;if(data instanceof ArrayBuffer)
response=new Response(data);else{let bytes=new Uint8Array(data.buffer,data.byteOffset,data.byteLength);response=new Response(
bytes.slice().buffer)}assert(response.body,"Response does not contain body.");try{return await new Response(response.body.
pipeThrough(new DecompressionStream(format),{signal})).arrayBuffer()}catch{throw signal?.throwIfAborted(),new Error(`Fai\
led to decode ${format}`)}}var LITTLE_ENDIAN_OS=systemIsLittleEndian();function systemIsLittleEndian(){let a=new Uint32Array([305419896]);return new Uint8Array(
a.buffer,a.byteOffset,a.byteLength)[0]!==18}function bytesPerElement(TypedArray){return"BYTES_PER_ELEMENT"in TypedArray?
TypedArray.BYTES_PER_ELEMENT:4}var BytesCodec=class _BytesCodec{kind="array_to_bytes";#stride;#TypedArray;#BYTES_PER_ELEMENT;#shape;#endian;constructor(configuration,meta){
this.#endian=configuration?.endian,this.#TypedArray=getCtr(meta.dataType),this.#shape=meta.shape,this.#stride=getStrides(
meta.shape,"C");let sample=new this.#TypedArray(0);this.#BYTES_PER_ELEMENT=sample.BYTES_PER_ELEMENT}static fromConfig(configuration,meta){
return new _BytesCodec(configuration,meta)}encode(arr){let bytes=new Uint8Array(arr.data.buffer);return LITTLE_ENDIAN_OS&&
this.#endian==="big"&&(bytes=bytes.slice(),byteswapInplace(bytes,bytesPerElement(this.#TypedArray))),bytes}computeEncodedSize(decodedSize){
return decodedSize}decode(bytes){return LITTLE_ENDIAN_OS&&this.#endian==="big"&&(bytes=bytes.slice(),byteswapInplace(bytes,
bytesPerElement(this.#TypedArray))),bytes.byteOffset%this.#BYTES_PER_ELEMENT!==0&&(bytes=bytes.slice()),{data:new this.#TypedArray(
bytes.buffer,bytes.byteOffset,bytes.byteLength/this.#BYTES_PER_ELEMENT),shape:this.#shape,stride:this.#stride}}};var SPECIAL_FLOATS={NaN:NaN,Infinity:1/0,"-Infinity":-1/0},FLOAT_BYTES={float16:2,float32:4,float64:8};function isFloatType(dataType){
return dataType in FLOAT_BYTES}function isBigintType(dataType){return dataType==="int64"||dataType==="uint64"}function hexToFloat(hex,byteWidth){
let int=BigInt(hex),buf=new ArrayBuffer(byteWidth),view=new DataView(buf);if(byteWidth===2){if(typeof view.getFloat16!="\
function")throw new UnsupportedError("float16 hex-encoded scalar decoding (requires DataView.prototype.getFloat16)");return view.
setUint16(0,Number(int)),view.getFloat16(0)}return byteWidth===4?(view.setUint32(0,Number(int)),view.getFloat32(0)):(view.
setBigUint64(0,int),view.getFloat64(0))}function parseJsonScalar(dataType,value){if(isBigintType(dataType)){if(typeof value!=
"number"||!Number.isInteger(value))throw new InvalidMetadataError(`Expected an integer value for data type "${dataType}"\
, got ${JSON.stringify(value)}`);return BigInt(value)}if(typeof value=="number"){if(!isFloatType(dataType)&&!Number.isInteger(
value))throw new InvalidMetadataError(`Expected an integer value for data type "${dataType}", got ${value}`);return value}
if(!isFloatType(dataType))throw new InvalidMetadataError(`String-encoded scalar "${value}" is not valid for non-float da\
ta type "${dataType}"`);return value in SPECIAL_FLOATS?SPECIAL_FLOATS[value]:hexToFloat(value,FLOAT_BYTES[dataType])}var SUPPORTED=new Set(["int8","uint8","int16","uint16","int32","uint32","int64","uint64","float16","float32","float64"]),
INT_BOUNDS={int8:[-(2**7),2**7-1],uint8:[0,2**8-1],int16:[-(2**15),2**15-1],uint16:[0,2**16-1],int32:[-(2**31),2**31-1],
uint32:[0,2**32-1]},BIGINT_BOUNDS={int64:[-(2n**63n),2n**63n-1n],uint64:[0n,2n**64n-1n]};function parseScalarMapEntries(entries,srcType,tgtType){
return entries.map(([src,tgt])=>({src:parseJsonScalar(srcType,src),tgt:parseJsonScalar(tgtType,tgt)}))}function scalarMapLookup(value,entries){
for(let entry of entries)if(typeof entry.src=="number"&&Number.isNaN(entry.src)){if(typeof value=="number"&&Number.isNaN(
value))return entry.tgt}else if(value===entry.src)return entry.tgt}function roundNearestEven(value){if(!Number.isFinite(
value))return value;if(Math.abs(value-Math.trunc(value))===.5){let floor=Math.floor(value),ceil=Math.ceil(value);return floor%
2===0?floor:ceil}return Math.round(value)}function nearestAway(value){return Math.sign(value)*Math.floor(Math.abs(value)+
.5)}function getRoundingFn(mode){switch(mode){case"nearest-even":return roundNearestEven;case"towards-zero":return Math.
trunc;case"towards-positive":return Math.ceil;case"towards-negative":return Math.floor;case"nearest-away":return nearestAway}}
function makeIntRangeCheck(lo,hi,outOfRange){let range=hi-lo+1;switch(outOfRange){case"clamp":return v=>v<lo?lo:v>hi?hi:
v;case"wrap":return v=>v>=lo&&v<=hi?v:((v-lo)%range+range)%range+lo;default:return v=>{if(v>=lo&&v<=hi)return v;throw new Error(
`Value ${v} out of range [${lo}, ${hi}]. Set out_of_range='clamp' or out_of_range='wrap' to handle this.`)}}}function makeBigintRangeCheck(lo,hi,outOfRange){
let range=hi-lo+1n;switch(outOfRange){case"clamp":return v=>v<lo?lo:v>hi?hi:v;case"wrap":return v=>v>=lo&&v<=hi?v:((v-lo)%
range+range)%range+lo;default:return v=>{if(v>=lo&&v<=hi)return v;throw new Error(`Value ${v} out of range [${lo}, ${hi}\
]. Set out_of_range='clamp' or out_of_range='wrap' to handle this.`)}}}var CastValueCodec=class _CastValueCodec{kind="ar\
ray_to_array";#encodedType;#arrayTypeCtr;#decodeValue;#encodeFillValue;constructor(arrayType,encodedType,rounding,outOfRange,decodeMapEntries,encodeMapEntries){
this.#encodedType=encodedType,this.#arrayTypeCtr=getCtr(arrayType),this.#decodeValue=buildConverter(encodedType,arrayType,
rounding,outOfRange,decodeMapEntries),this.#encodeFillValue=buildConverter(arrayType,encodedType,rounding,outOfRange,encodeMapEntries)}getEncodedMeta(meta){
let fillValue=meta.fillValue;return fillValue!=null&&(fillValue=this.#encodeFillValue(fillValue)),{...meta,dataType:this.#encodedType,
fillValue}}static fromConfig(config,meta){let arrayType=meta.dataType,encodedType=config.data_type;if(!SUPPORTED.has(arrayType))
throw new InvalidMetadataError(`cast_value codec does not support array data type: ${arrayType}`);if(!SUPPORTED.has(encodedType))
throw new InvalidMetadataError(`cast_value codec does not support encoded data type: ${encodedType}`);let rounding=config.
rounding??"nearest-even",decodeMapEntries=config.scalar_map?.decode?parseScalarMapEntries(config.scalar_map.decode,encodedType,
arrayType):[],encodeMapEntries=config.scalar_map?.encode?parseScalarMapEntries(config.scalar_map.encode,arrayType,encodedType):
[];return new _CastValueCodec(arrayType,encodedType,rounding,config.out_of_range,decodeMapEntries,encodeMapEntries)}encode=unimplementedEncode(
"cast_value");decode(chunk){let input=chunk.data,out=new this.#arrayTypeCtr(input.length);for(let i=0;i<input.length;i++)
out[i]=this.#decodeValue(input[i]);return{data:out,shape:chunk.shape,stride:chunk.stride}}};function buildConverter(sourceType,targetType,rounding,outOfRange,mapEntries){
let srcIsFloat=isFloatType(sourceType),srcIsBigint=isBigintType(sourceType),dstIsFloat=isFloatType(targetType),dstIsBigint=isBigintType(
targetType),baseFn;if(srcIsFloat&&dstIsFloat){if(rounding!=="nearest-even")throw new InvalidMetadataError(`cast_value fl\
oat -> float only supports "nearest-even" rounding, got "${rounding}"`);baseFn=v=>v}else if(srcIsFloat&&!dstIsFloat&&!dstIsBigint){
let round=getRoundingFn(rounding),check=makeIntRangeCheck(...INT_BOUNDS[targetType],outOfRange);baseFn=v=>{if(!Number.isFinite(
v))throw new Error(`Cannot cast ${v} to integer type without scalar_map`);return check(round(v))}}else if(srcIsFloat&&dstIsBigint){
let round=getRoundingFn(rounding),check=makeBigintRangeCheck(...BIGINT_BOUNDS[targetType],outOfRange);baseFn=v=>{if(!Number.
isFinite(v))throw new Error(`Cannot cast ${v} to integer type without scalar_map`);return check(BigInt(round(v)))}}else if(!srcIsFloat&&
!srcIsBigint&&dstIsFloat)baseFn=v=>v;else if(srcIsBigint&&dstIsFloat)baseFn=v=>Number(v);else if(!srcIsFloat&&!srcIsBigint&&
!dstIsFloat&&!dstIsBigint)baseFn=makeIntRangeCheck(...INT_BOUNDS[targetType],outOfRange);else if(!srcIsFloat&&!srcIsBigint&&
dstIsBigint){let check=makeBigintRangeCheck(...BIGINT_BOUNDS[targetType],outOfRange);baseFn=v=>check(BigInt(v))}else if(srcIsBigint&&
!dstIsFloat&&!dstIsBigint){let check=makeIntRangeCheck(...INT_BOUNDS[targetType],outOfRange);baseFn=v=>check(Number(v))}else if(srcIsBigint&&
dstIsBigint)baseFn=makeBigintRangeCheck(...BIGINT_BOUNDS[targetType],outOfRange);else throw new Error(`Unhandled type co\
mbination: ${sourceType} -> ${targetType}`);return mapEntries.length===0?baseFn:v=>{let mapped=scalarMapLookup(v,mapEntries);
return mapped!==void 0?mapped:baseFn(v)}}var Crc32cCodec=class _Crc32cCodec{kind="bytes_to_bytes";static fromConfig(){return new _Crc32cCodec}encode=unimplementedEncode(
"crc32c");decode(arr){return new Uint8Array(arr.buffer,arr.byteOffset,arr.byteLength-4)}computeEncodedSize(decodedSize){
return decodedSize+4}};var SUPPORTED2=new Set(["int8","uint8","int16","uint16","int32","uint32","int64","uint64","float16","float32","float64"]);
function assertCOrFContiguous(shape,stride){let n=shape.length,c=n===0||stride[n-1]===1;for(let i=n-2;i>=0&&c;i--)c=stride[i]===
stride[i+1]*shape[i+1];if(c)return;let f=n===0||stride[0]===1;for(let i=1;i<n&&f;i++)f=stride[i]===stride[i-1]*shape[i-1];
if(!f)throw new Error(`DeltaCodec requires C- or Fortran-contiguous strides, got shape=${JSON.stringify(shape)} stride=${JSON.
stringify(stride)}`)}var DeltaCodec=class _DeltaCodec{kind="array_to_array";#ctr;constructor(ctr){this.#ctr=ctr}static fromConfig(_config,meta){
if(!SUPPORTED2.has(meta.dataType))throw new InvalidMetadataError(`Delta codec does not support data type: ${meta.dataType}`);
return new _DeltaCodec(getCtr(meta.dataType))}encode(chunk){assertCOrFContiguous(chunk.shape,chunk.stride);let src=chunk.
data,out=new this.#ctr(src.length);out[0]=src[0];for(let i=1;i<src.length;i++)out[i]=src[i]-src[i-1];return{data:out,shape:chunk.
shape,stride:chunk.stride}}decode(chunk){assertCOrFContiguous(chunk.shape,chunk.stride);let src=chunk.data,out=new this.#ctr(
src.length);out[0]=src[0];for(let i=1;i<src.length;i++)out[i]=out[i-1]+src[i];return{data:out,shape:chunk.shape,stride:chunk.
stride}}};var GzipCodec=class _GzipCodec{kind="bytes_to_bytes";static fromConfig(_){return new _GzipCodec}encode=unimplementedEncode(
"gzip");async decode(bytes){let buffer=await decompress(bytes,{format:"gzip"});return new Uint8Array(buffer)}};function throwOnNanReplacer(_key,value){return assert(!Number.isNaN(value),"JsonCodec allow_nan is false but NaN was enc\
ountered during encoding."),assert(value!==Number.POSITIVE_INFINITY,"JsonCodec allow_nan is false but Infinity was encou\
ntered during encoding."),assert(value!==Number.NEGATIVE_INFINITY,"JsonCodec allow_nan is false but -Infinity was encoun\
tered during encoding."),value}function sortKeysReplacer(_key,value){return value instanceof Object&&!Array.isArray(value)?
Object.keys(value).sort().reduce((sorted,key)=>(sorted[key]=value[key],sorted),{}):value}var JsonCodec=class _JsonCodec{configuration;kind="\
array_to_bytes";#encoderConfig;#decoderConfig;constructor(configuration={}){this.configuration=configuration;let{encoding="\
utf-8",skipkeys=!1,ensure_ascii=!0,check_circular=!0,allow_nan=!0,sort_keys=!0,indent,strict=!0}=configuration,separators=configuration.
separators;separators||(indent?separators=[", ",": "]:separators=[",",":"]),this.#encoderConfig={encoding,skipkeys,ensure_ascii,
check_circular,allow_nan,indent,separators,sort_keys},this.#decoderConfig={strict}}static fromConfig(configuration){return new _JsonCodec(
configuration)}encode(buf){let{indent,encoding,ensure_ascii,check_circular,allow_nan,sort_keys}=this.#encoderConfig;assert(
encoding==="utf-8","JsonCodec does not yet support non-utf-8 encoding.");let replacerFunctions=[];assert(check_circular,
"JsonCodec does not yet support skipping the check for circular references during encoding."),allow_nan||replacerFunctions.
push(throwOnNanReplacer),sort_keys&&replacerFunctions.push(sortKeysReplacer);let items=Array.from(buf.data);items.push("\
|O"),items.push(buf.shape);let replacer;replacerFunctions.length&&(replacer=(key,value)=>{let newValue=value;for(let subReplacer of replacerFunctions)
newValue=subReplacer(key,newValue);return newValue});let jsonStr=JSON.stringify(items,replacer,indent);return ensure_ascii&&
(jsonStr=jsonStr.replace(/[\u007F-\uFFFF]/g,chr=>{let fullStr=`0000${chr.charCodeAt(0).toString(16)}`;return`\\u${fullStr.
substring(fullStr.length-4)}`})),new TextEncoder().encode(jsonStr)}decode(bytes){let{strict}=this.#decoderConfig;assert(
strict,"JsonCodec does not yet support non-strict decoding.");let items=jsonDecodeObject(bytes),shape=items.pop();items.
pop(),assert(shape,"0D not implemented for JsonCodec.");let stride=getStrides(shape,"C");return{data:items,shape,stride}}};var SUPPORTED3=new Set(["int8","uint8","int16","uint16","int32","uint32","int64","uint64","float16","float32","float64"]),
ScaleOffsetCodec=class _ScaleOffsetCodec{kind="array_to_array";#ctr;#scale;#offset;constructor(scale,offset,ctr){this.#scale=
scale,this.#offset=offset,this.#ctr=ctr}static fromConfig(config,meta){if(!SUPPORTED3.has(meta.dataType))throw new InvalidMetadataError(
`scale_offset codec does not support data type: ${meta.dataType}`);return new _ScaleOffsetCodec(parseJsonScalar(meta.dataType,
config.scale??1),parseJsonScalar(meta.dataType,config.offset??0),getCtr(meta.dataType))}encode=unimplementedEncode("scal\
e_offset");decode(chunk){let src=chunk.data,out=new this.#ctr(src.length);for(let i=0;i<src.length;i++)out[i]=src[i]/this.#scale+
this.#offset;return{data:out,shape:chunk.shape,stride:chunk.stride}}};var ShuffleCodec=class _ShuffleCodec{kind="bytes_to_bytes";#BYTES_PER_ELEMENT;constructor(configuration,meta){if(meta){let sample=new(getCtr(
meta.dataType))(0);assert("BYTES_PER_ELEMENT"in sample,`Shuffle codec requires a fixed-size dtype, got "${meta.dataType}\
"`),this.#BYTES_PER_ELEMENT=sample.BYTES_PER_ELEMENT}else this.#BYTES_PER_ELEMENT=configuration.elementsize??4}static fromConfig(configuration,meta){
return new _ShuffleCodec(configuration,meta)}encode(data){return shuffle(data,this.#BYTES_PER_ELEMENT)}decode(data){return unshuffle(
data,this.#BYTES_PER_ELEMENT)}};function shuffle(data,elementSize){let length2=data.length,nElements=Math.floor(length2/
elementSize),result=new Uint8Array(length2);for(let byte=0;byte<elementSize;byte++)for(let i=0;i<nElements;i++)result[byte*
nElements+i]=data[i*elementSize+byte];return result}function unshuffle(data,elementSize){let length2=data.length,nElements=Math.
floor(length2/elementSize),result=new Uint8Array(length2);for(let byte=0;byte<elementSize;byte++)for(let i=0;i<nElements;i++)
result[i*elementSize+byte]=data[byte*nElements+i];return result}function proxy(arr){return arr instanceof BoolArray||arr instanceof ByteStringArray||arr instanceof UnicodeStringArray?new Proxy(
arr,{get(target,prop){return target.get(Number(prop))},set(target,prop,value){return target.set(Number(prop),value),!0}}):
arr}function emptyLike(chunk,order){let data;return chunk.data instanceof ByteStringArray||chunk.data instanceof UnicodeStringArray?
data=new chunk.data.constructor(chunk.data.chars,chunk.data.length):data=new chunk.data.constructor(chunk.data.length),{
data,shape:chunk.shape,stride:getStrides(chunk.shape,order)}}function convertArrayOrder(src,target){let out=emptyLike(src,
target),nDims=src.shape.length,size=src.shape.reduce((a,b)=>a*b,1),index=Array(nDims).fill(0),srcData=proxy(src.data),outData=proxy(
out.data);for(let n=0;n<size;n++){let srcIdx=0,outIdx=0;for(let dim=0;dim<nDims;dim++)srcIdx+=index[dim]*src.stride[dim],
outIdx+=index[dim]*out.stride[dim];outData[outIdx]=srcData[srcIdx],index[0]+=1;for(let dim=0;dim<nDims;dim++)if(index[dim]===
src.shape[dim]){if(dim+1===nDims)break;index[dim]=0,index[dim+1]+=1}}return out}function getOrder(chunk){let rank=chunk.
shape.length;return assert(rank===chunk.stride.length,"Shape and stride must have the same length."),chunk.stride.map((s,i)=>({
stride:s,index:i})).sort((a,b)=>b.stride-a.stride).map(entry=>entry.index)}function matchesOrder(chunk,target){let source=getOrder(
chunk);return assert(source.length===target.length,"Orders must match"),source.every((dim,i)=>dim===target[i])}var TransposeCodec=class _TransposeCodec{kind="\
array_to_array";#order;constructor(configuration,meta){let value=configuration.order??"C",rank=meta.shape.length,order=new Array(
rank);if(value==="C")for(let i=0;i<rank;++i)order[i]=i;else if(value==="F")for(let i=0;i<rank;++i)order[i]=rank-i-1;else{
order=value;let seen=new Array(rank);order.forEach(x=>{assert(!seen[x],`Invalid permutation: ${JSON.stringify(value)}`),
seen[x]=!0})}this.#order=order}static fromConfig(configuration,meta){return new _TransposeCodec(configuration,meta)}encode(arr){
return matchesOrder(arr,this.#order)?arr:convertArrayOrder(arr,this.#order)}decode(arr){return{data:arr.data,shape:arr.shape,
stride:getStrides(arr.shape,this.#order)}}};var VLenUTF8=class _VLenUTF8{kind="array_to_bytes";#shape;#strides;constructor(shape){this.#shape=shape,this.#strides=getStrides(
shape,"C")}static fromConfig(_,meta){return new _VLenUTF8(meta.shape)}encode=unimplementedEncode("vlen-utf8");decode(bytes){
let decoder=new TextDecoder,view=new DataView(bytes.buffer),data=Array(view.getUint32(0,!0)),pos=4;for(let i=0;i<data.length;i++){
let itemLength=view.getUint32(pos,!0);pos+=4,data[i]=decoder.decode(bytes.buffer.slice(pos,pos+itemLength)),pos+=itemLength}
return{data,shape:this.#shape,stride:this.#strides}}};var ZlibCodec=class _ZlibCodec{kind="bytes_to_bytes";static fromConfig(_){return new _ZlibCodec}encode=unimplementedEncode(
"zlib");async decode(bytes){let buffer=await decompress(bytes,{format:"deflate"});return new Uint8Array(buffer)}};function createDefaultRegistry(){let blosc=()=>import("numcodecs/blosc").then(m=>m.default),lz4=()=>import("numcodecs/lz4").
then(m=>m.default),zstd=()=>import("numcodecs/zstd").then(m=>m.default),gzip=()=>GzipCodec,zlib=()=>ZlibCodec;return new Map().
set("blosc",blosc).set("lz4",lz4).set("zstd",zstd).set("gzip",gzip).set("zlib",zlib).set("transpose",()=>TransposeCodec).
set("bytes",()=>BytesCodec).set("crc32c",()=>Crc32cCodec).set("vlen-utf8",()=>VLenUTF8).set("json2",()=>JsonCodec).set("\
bitround",()=>BitroundCodec).set("cast_value",()=>CastValueCodec).set("scale_offset",()=>ScaleOffsetCodec).set("numcodec\
s.blosc",blosc).set("numcodecs.lz4",lz4).set("numcodecs.zstd",zstd).set("numcodecs.gzip",gzip).set("numcodecs.zlib",zlib).
set("numcodecs.vlen-utf8",()=>VLenUTF8).set("numcodecs.shuffle",()=>ShuffleCodec).set("numcodecs.delta",()=>DeltaCodec).
set("numcodecs.bitround",()=>BitroundCodec).set("numcodecs.json2",()=>JsonCodec)}var registry=createDefaultRegistry();function createCodecPipeline(chunkMetadata){
let codecsPromise;function getCodecs(){return codecsPromise||(codecsPromise=loadCodecs(chunkMetadata)),codecsPromise}async function runStep(direction,codec,fn){
try{return await fn()}catch(cause){throw new CodecPipelineError({direction,codec,cause})}}return{async encode(chunk){let codecs=await getCodecs();
for(let{name,codec}of codecs.arrayToArray)chunk=await runStep("encode",name,()=>codec.encode(chunk));let bytes=await runStep(
"encode",codecs.arrayToBytes.name,()=>codecs.arrayToBytes.codec.encode(chunk));for(let{name,codec}of codecs.bytesToBytes)
bytes=await runStep("encode",name,()=>codec.encode(bytes));return bytes},async decode(bytes){let codecs=await getCodecs();
for(let i=codecs.bytesToBytes.length-1;i>=0;i--){let{name,codec}=codecs.bytesToBytes[i];bytes=await runStep("decode",name,
()=>codec.decode(bytes))}let chunk=await runStep("decode",codecs.arrayToBytes.name,()=>codecs.arrayToBytes.codec.decode(
bytes));for(let i=codecs.arrayToArray.length-1;i>=0;i--){let{name,codec}=codecs.arrayToArray[i];chunk=await runStep("dec\
ode",name,()=>codec.decode(chunk))}return chunk},async computeEncodedSize(decodedSize){let codecs=await getCodecs(),size=applyEncodedSize(
codecs.arrayToBytes.name,codecs.arrayToBytes.codec,decodedSize);for(let{name,codec}of codecs.bytesToBytes)size=applyEncodedSize(
name,codec,size);return size}}}function applyEncodedSize(name,codec,size){if(!codec.computeEncodedSize)throw new InvalidMetadataError(
`Codec "${name}" cannot compute its encoded size; it is not a fixed-size codec and cannot be used in a sharding index pi\
peline`);return codec.computeEncodedSize(size)}async function loadCodecs(chunkMeta){let promises=chunkMeta.codecs.map(async meta=>{
let Codec=await registry.get(meta.name)?.();if(!Codec)throw new UnknownCodecError(meta.name);return{Codec,meta}}),arrayToArray=[],
arrayToBytes,bytesToBytes=[],currentMeta={...chunkMeta};for await(let{Codec,meta}of promises){let codec=Codec.fromConfig(
meta.configuration,currentMeta);switch(codec.kind){case"array_to_array":arrayToArray.push({name:meta.name,codec}),codec.
getEncodedMeta&&(currentMeta=codec.getEncodedMeta(currentMeta));break;case"array_to_bytes":arrayToBytes={name:meta.name,
codec};break;default:bytesToBytes.push({name:meta.name,codec})}}if(!arrayToBytes){if(!isTypedArrayLikeMeta(currentMeta))
throw new InvalidMetadataError(`Cannot encode ${currentMeta.dataType} to bytes without a codec`);arrayToBytes={name:"byt\
es",codec:BytesCodec.fromConfig({endian:"little"},currentMeta)}}return{arrayToArray,arrayToBytes,bytesToBytes}}function isTypedArrayLikeMeta(meta){
return meta.dataType!=="v2:object"&&meta.dataType!=="string"}var MAX_BIG_UINT=18446744073709551615n;function createShardedChunkGetter(location2,shardShape,encodeShardKey,shardingConfig){
if(!location2.store.getRange)throw new UnsupportedError("sharding requires a store with getRange");let getRange=location2.
store.getRange.bind(location2.store),indexShape=shardShape.map((d,i)=>d/shardingConfig.chunk_shape[i]),indexCodec=createCodecPipeline(
{dataType:"uint64",shape:[...indexShape,2],codecs:shardingConfig.index_codecs,fillValue:null}),rawIndexSize=16*indexShape.
reduce((a,b)=>a*b,1),cache={};return async(chunkCoord,options)=>{let shardCoord=chunkCoord.map((d,i)=>Math.floor(d/indexShape[i])),
shardPath=location2.resolve(encodeShardKey(shardCoord)).path;shardPath in cache||(cache[shardPath]=(async()=>{let suffixLength=await indexCodec.
computeEncodedSize(rawIndexSize),bytes=await getRange(shardPath,{suffixLength},options);return bytes?await indexCodec.decode(
bytes):null})().catch(err=>{throw delete cache[shardPath],err}));let index=await cache[shardPath];if(index===null)return;
let{data,shape,stride}=index,linearOffset=chunkCoord.map((d,i)=>d%shape[i]).reduce((acc,sel,idx)=>acc+sel*stride[idx],0),
offset=data[linearOffset],length2=data[linearOffset+1];if(!(offset===MAX_BIG_UINT&&length2===MAX_BIG_UINT))return getRange(
shardPath,{offset:Number(offset),length:Number(length2)},options)}}var Location=class _Location{store;path;constructor(store,path="/"){this.store=store,this.path=path}resolve(path){let root2=new URL(
`file://${this.path.endsWith("/")?this.path:`${this.path}/`}`);return new _Location(this.store,decodeURIComponent(new URL(
path,root2).pathname))}};function root(store){return new Location(store??new Map)}var Group=class extends Location{kind="\
group";#metadata;constructor(store,path,metadata){super(store,path),this.#metadata=metadata}get attrs(){return this.#metadata.
attributes}};function getArrayOrder(codecs){return codecs.find(c=>c.name==="transpose")?.configuration?.order??"C"}function projectOrder(order,axes){
let rank=new Map(axes.map((axis,i)=>[axis,i]));return order.filter(axis=>rank.has(axis)).map(axis=>rank.get(axis))}function makeStrideGetter(nativeOrder){
return(shape,axes)=>{let order=globalThis.Array.isArray(nativeOrder)&&axes?projectOrder(nativeOrder,axes):nativeOrder;return getStrides(
shape,order)}}var CONTEXT_MARKER=Symbol("zarrita.context");function createContext(location2,metadata){let{configuration}=metadata.codecs.find(isShardingCodec)??{},sharedContext={encodeChunkKey:createChunkKeyEncoder(
metadata.chunk_key_encoding),TypedArray:getCtr(metadata.data_type),fillValue:metadata.fill_value};if(configuration){let nativeOrder2=getArrayOrder(
configuration.codecs);return{...sharedContext,kind:"sharded",chunkShape:configuration.chunk_shape,codec:createCodecPipeline(
{dataType:metadata.data_type,shape:configuration.chunk_shape,codecs:configuration.codecs,fillValue:metadata.fill_value}),
getStrides:makeStrideGetter(nativeOrder2),getChunkBytes:createShardedChunkGetter(location2,metadata.chunk_grid.configuration.
chunk_shape,sharedContext.encodeChunkKey,configuration)}}let nativeOrder=getArrayOrder(metadata.codecs);return{...sharedContext,
kind:"regular",chunkShape:metadata.chunk_grid.configuration.chunk_shape,codec:createCodecPipeline({dataType:metadata.data_type,
shape:metadata.chunk_grid.configuration.chunk_shape,codecs:metadata.codecs,fillValue:metadata.fill_value}),getStrides:makeStrideGetter(
nativeOrder),async getChunkBytes(chunkCoords,options){let chunkKey=sharedContext.encodeChunkKey(chunkCoords),chunkPath=location2.
resolve(chunkKey).path;return location2.store.get(chunkPath,options)}}}var Array2=class extends Location{kind="array";#metadata;[CONTEXT_MARKER];constructor(store,path,metadata){
super(store,path),this.#metadata={...metadata,fill_value:ensureCorrectScalar(metadata)},this[CONTEXT_MARKER]=createContext(
this,this.#metadata)}get attrs(){return this.#metadata.attributes}get dimensionNames(){return this.#metadata.dimension_names}get fillValue(){
return this.#metadata.fill_value}get shape(){return this.#metadata.shape}get chunks(){return this[CONTEXT_MARKER].chunkShape}get dtype(){
return this.#metadata.data_type}async getChunk(chunkCoords,options,opts){opts?.useSharedArrayBuffer&&assertSharedArrayBufferAvailable();
let context=this[CONTEXT_MARKER],maybeBytes=await context.getChunkBytes(chunkCoords,options);if(!maybeBytes){let size=context.
chunkShape.reduce((a,b)=>a*b,1),data;if(opts?.useSharedArrayBuffer){let sample=new context.TypedArray(0);if(!("BYTES_PER\
_ELEMENT"in sample))console.warn("zarrita: useSharedArrayBuffer is not supported for non-buffer-backed data types."),data=
new context.TypedArray(size);else{let buffer=createBuffer(size*sample.BYTES_PER_ELEMENT,!0);data=new context.TypedArray(
buffer,0,size)}}else data=new context.TypedArray(size);return data.fill(context.fillValue),{data,shape:context.chunkShape,
stride:context.getStrides(context.chunkShape)}}return context.codec.decode(maybeBytes)}is(query){return isDataType(this.
dtype,query)}};function applyExtensions(value,extensions){let result=value;for(let ext of extensions)result instanceof Promise?result=result.
then(v=>ext(v)):result=ext(result);return result}function extendArray(array,...extensions){return applyExtensions(array,extensions)}async function maybeExtend(array){let exts=array.store.arrayExtensions;return exts?.length?await extendArray(array,...exts):
array}var VERSION_COUNTER=createVersionCounter();function createVersionCounter(){let versionCounts=new WeakMap;function getCounts(store){
let counts=versionCounts.get(store)??{v2:0,v3:0};return versionCounts.set(store,counts),counts}return{increment(store,version){
getCounts(store)[version]+=1},versionMax(store){let counts=getCounts(store);return counts.v3>counts.v2?"v3":"v2"}}}async function loadAttrs(location2,signal){
let metaBytes=await location2.store.get(location2.resolve(".zattrs").path,{signal});return metaBytes?jsonDecodeObject(metaBytes):
{}}async function openV2(location2,options={}){let loc="store"in location2?location2:new Location(location2),{signal}=options,
attrs={};return(options.attrs??!0)&&(attrs=await loadAttrs(loc,signal)),signal?.throwIfAborted(),options.kind==="array"?
openArrayV2(loc,attrs,signal):options.kind==="group"?openGroupV2(loc,attrs,signal):openArrayV2(loc,attrs,signal).catch(err=>(rethrowUnless(
err,NotFoundError,InvalidMetadataError),openGroupV2(loc,attrs,signal)))}async function openArrayV2(location2,attrs,signal){
let{path}=location2.resolve(".zarray"),meta=await location2.store.get(path,{signal});if(!meta)throw new NotFoundError("v\
2 array",{path});return VERSION_COUNTER.increment(location2.store,"v2"),maybeExtend(new Array2(location2.store,location2.
path,v2ToV3ArrayMetadata(jsonDecodeObject(meta),attrs)))}async function openGroupV2(location2,attrs,signal){let{path}=location2.
resolve(".zgroup"),meta=await location2.store.get(path,{signal});if(!meta)throw new NotFoundError("v2 group",{path});return VERSION_COUNTER.
increment(location2.store,"v2"),new Group(location2.store,location2.path,v2ToV3GroupMetadata(jsonDecodeObject(meta),attrs))}
async function _openV3(location2,signal){let{store,path}=location2.resolve("zarr.json"),meta=await location2.store.get(path,
{signal});if(!meta)throw new NotFoundError("v3 array or group",{path});let metaDoc=jsonDecodeObject(meta);return metaDoc.
node_type==="array"&&(metaDoc.fill_value=ensureCorrectScalar(metaDoc)),metaDoc.node_type==="array"?maybeExtend(new Array2(
store,location2.path,metaDoc)):new Group(store,location2.path,metaDoc)}async function openV3(location2,options={}){let loc="\
store"in location2?location2:new Location(location2),node=await _openV3(loc,options.signal);if(VERSION_COUNTER.increment(
loc.store,"v3"),options.kind===void 0||options.kind==="array"&&node instanceof Array2||options.kind==="group"&&node instanceof
Group)return node;let kind=node instanceof Array2?"array":"group";throw new NotFoundError(`${options.kind} at ${loc.path}`,
{path:loc.path,found:kind})}async function open(location2,options={}){let store="store"in location2?location2.store:location2,
versionMax=VERSION_COUNTER.versionMax(store),openPrimary=versionMax==="v2"?open.v2:open.v3,openSecondary=versionMax==="v\
2"?open.v3:open.v2;return openPrimary(location2,options).catch(err=>(rethrowUnless(err,NotFoundError,InvalidMetadataError),
openSecondary(location2,options)))}open.v2=openV2;open.v3=openV3;var PAUSES_MS=[300,1e3,3e3],STALL_MS=2e4,ABSENT=[401,403,404,410],OK=200,BUSY=429,FAULT=500,CASTAGNOLI=2197175160,SUM_BYTES=4,
NUMBER_BYTES=8,MOST_CHUNK_BYTES=1<<28,StoreError=class extends Error{fault;detail;constructor(fault,message,detail=message){
super(message),this.fault=fault,this.detail=detail}},sums=Array.from({length:4},(_,more)=>Uint32Array.from({length:256},
(__,byte)=>{let sum=byte;for(let bit=0;bit<8*(more+1);bit+=1)sum=sum>>>1^(sum&1?CASTAGNOLI:0);return sum}));function crc32c(bytes){
let[last,third,second,first]=sums,whole=bytes.length-bytes.length%4,sum=4294967295;for(let n=0;n<whole;n+=4)sum^=bytes[n]|
bytes[n+1]<<8|bytes[n+2]<<16|bytes[n+3]<<24,sum=first[sum&255]^second[sum>>>8&255]^third[sum>>>16&255]^last[sum>>>24];for(let n=whole;n<
bytes.length;n+=1)sum=sum>>>8^last[(sum^bytes[n])&255];return~sum>>>0}async function joined(stream,grown){let pieces=[],
size=0,reader=stream?.getReader();try{for(;;){let{done=!0,value}=await reader?.read()??{};if(done||!value)break;pieces.push(
value),size+=value.length,grown(size)}}catch(error){throw reader?.cancel().catch(()=>{}),error}let bytes=new Uint8Array(
size);return pieces.reduce((at,piece)=>(bytes.set(piece,at),at+piece.length),0),bytes}var CheckSum=class _CheckSum{kind="\
bytes_to_bytes";static fromConfig(){return new _CheckSum}encode(){throw new Error("nothing is written")}decode(bytes){let end=bytes.
byteLength-SUM_BYTES;if(end<0)throw new Error("the checksum is missing");let{buffer,byteOffset}=bytes,told=new DataView(
buffer,byteOffset+end,SUM_BYTES).getUint32(0,!0),inside=new Uint8Array(buffer,byteOffset,end);if(told!==crc32c(inside))throw new Error(
"checksum mismatch");return inside}computeEncodedSize(size){return size+SUM_BYTES}},Gzip=class _Gzip{kind="bytes_to_byte\
s";most;constructor(most){this.most=most}static fromConfig(_,{shape}){return new _Gzip(Math.min(shape.reduce((size,n)=>size*
n,NUMBER_BYTES),MOST_CHUNK_BYTES))}encode(){throw new Error("nothing is written")}async decode(bytes){let packed=new Blob(
[bytes]).stream();return joined(packed.pipeThrough(new DecompressionStream("gzip")),size=>{if(size>this.most)throw new Error(
`a chunk unpacks to more than ${this.most} bytes`)})}};registry.set("gzip",()=>Promise.resolve(Gzip));registry.set("crc3\
2c",()=>Promise.resolve(CheckSum));function paused(wait,signal){return new Promise((resolve,reject)=>{let stop=()=>{clearTimeout(
timer),reject(signal.reason)},timer=setTimeout(()=>{signal.removeEventListener("abort",stop),resolve()},wait);signal.addEventListener(
"abort",stop,{once:!0})})}async function answer(url,signal){let controller=new AbortController,stop=()=>controller.abort();
signal.addEventListener("abort",stop,{once:!0});let timer=setTimeout(stop,STALL_MS);try{signal.throwIfAborted();let{status,
body}=await fetch(url,{signal:controller.signal}),bytes=await joined(status===OK?body:null,()=>{clearTimeout(timer),timer=
setTimeout(stop,STALL_MS)});return[status,bytes]}finally{controller.abort(),clearTimeout(timer),signal.removeEventListener(
"abort",stop)}}async function object(url,signal){for(let trial=0;;trial+=1){let said="no server answers";try{let[status,
bytes]=await answer(url,signal);if(status===OK)return bytes;if(ABSENT.includes(status))return;if(said=`the server answer\
s ${status}`,status<FAULT&&status!==BUSY)throw new StoreError("broken",said)}catch(error){if(signal.throwIfAborted(),error instanceof
StoreError)throw error}if(trial===PAUSES_MS.length)throw new StoreError("unreachable",said);await paused(PAUSES_MS[trial],
signal)}}var Objects=class{url;described;shards=new Map;constructor(url,described){this.url=url,this.described=described}get=async(key,options)=>key.
endsWith("/zarr.json")?this.description(key):this.object(key,options?.signal);getRange=async(key,range,options)=>{let bytes=this.
shards.get(key)??this.object(key,options?.signal);this.shards.set(key,bytes);let all=await bytes;return"suffixLength"in range?
all?.subarray(-range.suffixLength):all?.subarray(range.offset,range.offset+range.length)};async object(key,signal=new AbortController().
signal){let bytes=await object(this.url+key,signal);if(!bytes)throw new StoreError("missing",`${key} is missing`);return bytes}description(key){
let known=this.described.get(key);if(known)return known;let found=object(this.url+key,new AbortController().signal);return this.
described.set(key,found),found.catch(()=>this.described.delete(key)),found}};function storeError(error){if(error instanceof
StoreError)return error;let fault=error instanceof NotFoundError&&!error.found?"missing":"broken";return new StoreError(
fault,error instanceof Error?error.message:String(error))}var Store=class{url;described=new Map;constructor(url){this.url=
url.replace(/\/+$/,"")}async attributes(){let objects=new Objects(this.url,this.described);return(await open.v3(root(objects),
{kind:"group"})).attrs}async array(path){let objects=new Objects(this.url,this.described),array=await open.v3(root(objects).
resolve(path),{kind:"array"});if(!array.is("number"))throw new StoreError("broken",`${path} has no numbers`);return array}};var nameOf=key=>key.join("/");var MOST_LAYERS=64,MOST_LAGS=32,MOST_NODES=4096,MOST_BYTES=2**28,TRACED_FROM=["padded","unit","open","nearest","normal",
"rays"],REASONS={missing:"it is not in the store, or the store is not public.",broken:"its data in the store are corrupt\
.",unreachable:"the store does not answer. The server or the network may be down, or the server does not allow this page\
 to read it (CORS)."},IDENTITY=["format","fingerprint","parameter","lines"],isCount=(value,most)=>Number.isInteger(value)&&
Number(value)>0&&Number(value)<=most,areNumbers=(values,count)=>Array.isArray(values)&&values.every(Number.isFinite)&&(count??
values.length)===values.length,areWhole=(values,count)=>areNumbers(values,count)&&values.every(Number.isInteger);function arePoles({
nodes,longest=0,poles=[]}){return Number.isFinite(longest)&&poles.length<=2&&poles.every(({component,line,inward,near,plane})=>[
0,1].includes(component)&&component===poles[0].component&&line===(inward>0?0:nodes[1-component]-1)&&[1,-1].includes(inward)&&
isCount(near,MOST_NODES)&&areNumbers(plane,6))}function checkHeader(own,{geometry:whole,slices:all}){let{geometry,slices}=own,
{shape,rows,columns}=geometry,{trace}=slices;if(!(areNumbers(shape,2)&&shape.every(n=>isCount(n,MOST_NODES)&&n>1)&&[rows,
columns].every(({before,size},axis)=>Number.isInteger(before)&&isCount(size,MOST_NODES)&&before>=0&&before+shape[axis]<=
size)&&Number.isInteger(geometry.levels)&&geometry.levels>=0&&2**geometry.levels<=Math.max(rows.size,columns.size)&&geometry.
triangles===whole.triangles&&geometry.planar===whole.planar&&Number.isFinite(geometry.extent)&&areNumbers(geometry.periodic.
map(Number),2)&&areNumbers(geometry.center,3)&&areNumbers(geometry.frame,9)&&isCount(slices.count,MOST_LAYERS)&&[2,4].includes(
slices.channels)&&areNumbers(slices.lags)&&isCount(slices.lags.length,MOST_LAGS)&&slices.sides===all.sides&&areNumbers(slices.
extra)&&slices.extra.every(n=>Number.isInteger(n)&&n>=0&&n<slices.count)&&areNumbers([slices.unit,slices.cell,slices.critical])&&
(!trace||trace.parts.every(part=>TRACED_FROM.includes(part))&&areNumbers(trace.nodes,2)&&trace.nodes.every((n,axis)=>isCount(
n,MOST_NODES)&&trace.drawn[axis]+shape[axis]<=n)&&areWhole([...trace.first,...trace.drawn],4)&&trace.drawn.every(n=>n>=0)&&
areNumbers(trace.closed.map(Number),2)&&areNumbers([...trace.offset,...trace.middle,trace.unit,trace.pace,trace.rest],12)&&
arePoles(trace)&&(!trace.timed||areNumbers([trace.timed.unit,trace.timed.speed],2)))))throw new Error("the header of a t\
ile does not match the page")}function sizesOf({geometry,slices}){let{shape,planar}=geometry,{trace,count,channels,extra}=slices,
size=(numbers,...more)=>[...numbers,...more].reduce((a,b)=>a*b,1),texels=[geometry.rows.size,geometry.columns.size],nodes=trace?.
nodes??[],sizes={cells:[Uint8Array,[size(shape.map(n=>n-1))]],normal:[Int16Array,[size(shape,3)]],scalars:[Float32Array,
[size(shape)]]};if(trace){sizes.unit=[Uint16Array,[size(nodes)]],sizes.padded=[Float32Array,[size(nodes.map(n=>n+2),3)]],
sizes.open=[Uint8Array,[size(nodes)]],sizes.nearest=[Int16Array,[size(nodes,2)]];let poles=trace.poles??[];sizes.rays=[Float32Array,
[size(poles.slice(0,1).map(pole=>nodes[pole.component]),2,poles.length)]],sizes.flow=[Uint16Array,trace.uncertain?[size(
nodes,5)]:[size(nodes,3),size(nodes,4)]]}else sizes.position=[Float32Array,[size(shape,3)]],sizes.slices=[Uint16Array,[size(
texels,count,channels)]],sizes.extra=[Uint16Array,[size(texels,extra.length)]];let needed=trace?["mesh",...trace.parts]:
["mesh","position",...planar?[]:["normal"]];return{sizes,needed}}function checkParts(parts,header,tileCells){let{sizes}=sizesOf(
header),blocks=header.geometry.shape.map(n=>Math.ceil((n-1)/tileCells));for(let{name,data,shape:own}of parts){let kind=sizes[name.
split("/")[0]];if(!(kind?data instanceof kind[0]&&kind[1].includes(data.length):name==="mesh"&&data instanceof Float32Array&&
own.length===3&&own[0]===blocks[0]&&own[1]===blocks[1]&&data.length===own[0]*own[1]*own[2]))throw new Error(`the part "${name}\
" of a tile has a wrong size`)}}function speedOf(flow,{geometry,slices},typical){let[rows,columns]=geometry.shape,[channels,
{drawn,nodes}={drawn:[0,0],nodes:[0,0]}]=[flow.shape[2],slices.trace],data=new Float32Array(rows*columns);for(let n=0;n<
data.length;n+=1){let at=(Math.floor(n/columns)+drawn[0])*nodes[1]+n%columns+drawn[1];data[n]=typical*HALVES[Number(flow.
data[channels*(at+1)-1-Number(slices.trace?.uncertain??!1)])]}return{name:"",data,shape:[rows,columns],digest:`${flow.digest}\
 speed`}}function explained(error){let known=storeError(error);return known.fault==="other"||known.detail!==known.message?
known:new StoreError(known.fault,REASONS[known.fault],known.message)}var Stream=class{hasSteps=!0;atOnce=6;memory=18e7;header;told;url;store;headers=new Map;opening=null;constructor(header,base){
let told=header.store;if(!told)throw new Error("the page does not say where its store is");this.header=header,this.told=
told,this.url=new URL(told.url,base),this.store=new Store(this.url.href)}open(){return this.opening??=this.compare().catch(
error=>{let fault=explained(error);throw fault.fault==="unreachable"&&(this.opening=null),fault}),this.opening}async compare(){
let{url}=this.told;if(!/^https?:/.test(this.url.protocol)){let text2=`This page reads its store from ${url} in the same \
folder, which browsers do not allow when the page is opened as a file: open it from a web server.`;throw new StoreError(
"other",text2)}let own=(await this.store.attributes()).flowtex;if(IDENTITY.every(name=>own?.[name]===this.told[name]))return;
let text=`The store at ${url} does not match this page: it has another flow, other paths or another version: export the \
page again.`;throw new StoreError("other",text)}load=async(tile,steps,signal,has)=>{let key=tile??[this.told.depth,0,0],
name=nameOf(key);return this.loaded(signal,async whole=>{let late=steps.filter(step=>!has(`slices/${step}`)&&!has(`flow/${step}`)),
known=tile?has("header")&&!late.length?this.headers.get(name):void 0:this.header,surface=known===void 0?this.surface(key,
whole):{header:known,parts:[]},coming=new Map(late.map(step=>[step,this.flow(key,step,whole)])),flows=[...coming.values()],
rest=async()=>{let{header,parts:parts2}=await surface;if(tile&&this.headers.set(name,header),!header)return parts2;let[values,
...slices]=await Promise.all([this.values(key,header,steps,has,whole,coming),...flows]);if(checkParts(slices.flat(),header,
this.header.mesh.tileCells),!slices.every(each=>each.length))throw new Error(`tile ${name} has no flow`);return[...parts2,
...slices.flat(),...values]},[parts]=await Promise.all([rest(),...flows]);return tile?parts.map(part=>({...part,name:`ti\
le/${name}/${part.name}`})):parts})};async loaded(signal,load){let controller=new AbortController;signal.addEventListener(
"abort",()=>controller.abort(),{once:!0});try{return await this.open(),signal.throwIfAborted(),await load(controller.signal)}catch(error){
throw signal.throwIfAborted(),explained(error)}finally{controller.abort()}}async file(kind,key,at,signal){let array=await this.
store.array(`${key[0]}/${kind}`),chunk=async n=>{let{data}=await array.getChunk([...at,n],{signal});if(!(data instanceof
Uint8Array))throw new Error(`${array.path} is empty`);return data},first=await chunk(0),[infos,start]=infosOfFile(first),
size=infos.reduce((sum,{bytes})=>sum+bytes,start);if(!isCount(size,MOST_BYTES))throw new Error(`a file of ${array.path} \
has a wrong size`);let file=new Uint8Array(Math.ceil(size/first.length)*first.length);file.set(first);for(let n=1;n*first.
length<size;n+=1)file.set(await chunk(n),n*first.length);let parts=new Map;for(let part of partsOfFile(file.buffer)){let[
tile,name]=tilePart(part.name)??["",part.name];if(tile&&tile!==nameOf(key))throw new Error(`in place of tile ${nameOf(key)}\
 is ${tile}`);parts.set(name,{...part,name})}if(new TextDecoder().decode(parts.get("of")?.data)!==this.told.fingerprint)
throw new Error(`tile ${nameOf(key)} belongs to another flow`);return parts.delete("of"),parts}async surface(key,signal){
let parts=await this.file("surface",key,[key[1],key[2]],signal),header=this.tileHeader(parts.get("header"));if(parts.delete(
"header"),header){let missing=sizesOf(header).needed.filter(name=>!parts.has(name));if(missing.length)throw new Error(`a\
 tile has no ${missing.join(", ")}`);checkParts([...parts.values()],header,this.header.mesh.tileCells)}let text=new TextEncoder().
encode(JSON.stringify(header)),told={name:"header",data:text,shape:[text.length],digest:`${this.told.fingerprint} ${nameOf(
key)} header`};return{header,parts:[told,...parts.values()]}}tileHeader(part){let own=JSON.parse(new TextDecoder().decode(
part?.data));if(own===null)return null;let{steps,times,timeUnit,dates,pace}=this.header.slices;return checkHeader(own,this.
header),{...own,slices:{...own.slices,steps,times,timeUnit,dates,pace}}}async flow(key,step,signal){let source=this.told.
steps[step];return[...(await this.file("flow",key,[source,key[1],key[2]],signal)).values()].map(part=>{let[kind,own]=part.
name.split("/");if(Number(own)!==source)throw new Error(`in place of step ${source} is ${part.name}`);return{...part,name:`${kind}\
/${step}`}})}async values(key,place,steps,has,signal,coming){let parts=new Map;for(;;){let{name,steps:count,number}=this.
header.scalars,names=(count>1?steps:[0]).map(step=>number?`scalars/${step}/${number}`:`scalars/${step}`),lacking=name===
null?[]:names.filter(each=>!has(each)&&!parts.has(each));if(!lacking.length)return[...parts.values()];let found=await Promise.
all(lacking.map(async each=>{let step=count>1?stepOf(each):0;if(!number&&this.told.derivesSpeed&&place.slices.trace){let[
flow]=await(coming.get(step)??this.flow(key,step,signal));return{...speedOf(flow,place,this.header.speed.typical),name:each}}
let source=count>1?this.told.steps[step]:0,part=(await this.file("values",key,[source,key[1],key[2],number],signal)).get(
`scalars/${source}/${number}`);if(!part)throw new Error(`tile ${nameOf(key)} has no values of step ${source}`);return{...part,
name:each}}));checkParts(found,place,this.header.mesh.tileCells);for(let part of found)parts.set(part.name,part)}}};var open2=header=>new Stream(header,location.href);return __toCommonJS(store_exports);})();
